#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/robot/robot_model.h"
#include "hires/robot/robot_profile.h"

namespace hires::robot {

/// The robot as a request or a saved state names it.
struct RobotState {
  geometry::Pose2 X_MB;  ///< base in map
  geometry::Twist2 V_B;  ///< base velocity, in the base frame
  JointPositions joints;
  bool operator==(const RobotState& other) const;
};

/// What a skill gets to see at each of its control cycles.
struct Observation {
  double time{0.0};                            ///< [s] since the action began
  geometry::Pose2 X_MB;                        ///< where the robot believes to stand
  geometry::Twist2 V_B;                        ///< odometry, in the base frame
  std::vector<geometry::Polygon> obstacles_M;  ///< outlines seen now that are not in the map
};

/// What a skill wants from the robot until its next cycle. Nothing set means: no new command (the
/// base brakes after its timeout).
struct Command {
  std::optional<geometry::Twist2> base_velocity;  ///< in the base frame
  std::optional<MotionSet> motion_set;            ///< limits in force from now on
};

}  // namespace hires::robot
