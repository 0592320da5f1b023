#pragma once

#include <string>

#include "hires/robot/robot_model.h"

namespace hires::robot {

/// Where a thing is put on a link that carries things, when no file says where.
struct TrayPlace {
  geometry::Pose3 X_TO;  ///< upright on the top of its largest shape from above
  std::string taken_by;  ///< link that takes the middle; "": it is free, and X_TO is there
  double radius{0.0};    ///< [m] of the largest free circle, round X_TO, where the middle is taken
  bool is_free{true};    ///< false: no part of the plate is free, X_TO is its middle
};

/// The middle of the plate where nothing else of the robot stands within 5 cm of it (or nearer than
/// its edge), up to 0.15 m over it; else the middle of the largest circle there that is free.
/// @pre `link` is one of the model's and has a collision shape; joints are within limits.
TrayPlace PlaceOnTray(const RobotModel& model, const JointPositions& joints,
                      const std::string& link);

}  // namespace hires::robot
