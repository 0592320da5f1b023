#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>

#include "hires/geometry/pose.h"
#include "hires/imagination/uncertainty.h"

namespace hires::imagination {

/// How uncertain it is where the robot stands: standard deviations along its own axes, and how they
/// go together.
struct StartSpread {
  double x{0.0}, y{0.0};  ///< [m]
  double yaw{0.0};        ///< [rad]
  PoseCorrelation correlation;
};

/// Where the robot's localisation believes it to be, and how sure it is.
struct BelievedPose {
  geometry::Pose2 X_MB;
  /// x, y, yaw in the map's axes [m^2, m rad, rad^2]; 0: nobody says how sure it is.
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};
};

/// @throws base::ConfigError: not finite, a negative variance, deviations beyond 1 m or 3.2 rad (a
/// robot that is lost has no start pose to imagine from).
StartSpread SpreadOf(const BelievedPose& believed, const std::string& where);

/// Whether a request begins where the robot stands now: within 0.25 m and 0.55 rad of where the
/// localisation saw it last, for amcl speaks again after 0.2 m or 0.5 rad. An imagined action that
/// begins somewhere else begins after a drive, and what is uncertain then is where it ends:
/// start_x, docked_x, ...
bool BeginsHere(const geometry::Pose2& X_MStart, const BelievedPose& believed);

/// The uncertainty with another spread of start poses: normal, around where the robot is believed
/// to stand. Of an uncertainty that names no start pose (none, say) nothing is changed.
Uncertainty WithStartSpread(const Uncertainty& uncertainty, const StartSpread& spread);

/// The uncertainty of what begins at a pose: with the spread of where the robot stands, if it
/// begins there and its localisation says how sure it is; else the one given.
/// @param where  for messages: who says it.  @throws base::ConfigError as SpreadOf.
std::shared_ptr<const Uncertainty> UncertaintyFrom(std::shared_ptr<const Uncertainty> uncertainty,
                                                   const geometry::Pose2& X_MStart,
                                                   const std::optional<BelievedPose>& believed,
                                                   const std::string& where);

}  // namespace hires::imagination
