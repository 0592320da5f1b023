#pragma once

#include "hires/localisation/robot_log.h"

namespace hires::localisation {

/// How far a trajectory is from the true one.
struct PathError {
  double rms{0.0}, max{0.0};  ///< [m] of the distances, after X_TP
  geometry::Pose2 X_TP;       ///< rigid motion that fits the trajectory's frame to the truth's best
};

/// @pre one true pose for each pose, at least one.  @throws std::logic_error if broken.
PathError ErrorOf(const TimedPath& path, const TimedPath& truth);

}  // namespace hires::localisation
