#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/robot/readings.h"
#include "hires/robot/robot_model.h"
#include "hires/robot/robot_profile.h"
#include "hires/robot/trajectory.h"

namespace hires::robot {

/// The robot as a request or a saved state names it.
struct RobotState {
  geometry::Pose2 X_MB;  ///< base in map
  geometry::Twist2 V_B;  ///< base velocity, in the base frame
  JointPositions joints;
  bool operator==(const RobotState& other) const;
};

/// A loose object that the robot knows from looking.
struct SeenObject {
  std::string name;         ///< instance, lower case
  std::string model;        ///< key of World::models
  geometry::Pose3 X_MO;     ///< where it was seen, in the map as the robot believes it
  double time{0.0};         ///< [s] when it was seen last, on the clock of Observation::time
  std::string attached_to;  ///< robot link that holds it, or empty
};

/// What a skill gets to see at each of its control cycles.
struct Observation {
  double time{0.0};                            ///< [s] since the action began
  geometry::Pose2 X_MB;                        ///< where the robot believes to stand
  double position_sd{0.0};                     ///< [m] of X_MB, in the worst direction; 0: not told
  geometry::Pose2 X_OB;                        ///< odometry: drifts, but does not jump
  geometry::Twist2 V_B;                        ///< odometry, in the base frame
  std::shared_ptr<const PlacedScan> scan;      ///< of the base's laser, the last; null: none
  double scan_age{0.0};                        ///< [s] since it was taken
  std::vector<geometry::Polygon> obstacles_M;  ///< outlines seen now that are not in the map
  JointPositions joints;  ///< measured; gripper joints are gaps [m]. Empty at level `tray`
  JointPositions joint_velocities;  ///< [rad/s] or [m/s], likewise
  std::vector<SeenObject>
      objects;           ///< all that are remembered, by name; vanished ones are left out
  int num_newcomers{0};  ///< things that the last look saw, of which more looks must tell what
                         ///< they are
};

/// How a gripper shall close.
struct GripperCommand {
  double gap{0.0};          ///< [m] between the finger tips
  double max_effort{-1.0};  ///< [N]; negative: no limit
};

/// What a skill wants from the robot until its next cycle. Nothing set means: no new command (the
/// base brakes after its timeout; joints finish the trajectory that they were given last).
struct Command {
  std::optional<geometry::Twist2> base_velocity;  ///< in the base frame
  std::optional<MotionSet> motion_set;            ///< limits in force from now on
  /// Replace what a group of joints does, starting now: "torso", "head", or an arm ("leftarm1").
  std::map<std::string, JointTrajectory> trajectories;
  std::map<std::string, GripperCommand> grippers;  ///< by arm
};

}  // namespace hires::robot
