#pragma once

#include <map>
#include <string>
#include <vector>

#include "hires/geometry/polygon.h"
#include "hires/geometry/pose.h"
#include "hires/robot/robot_model.h"

namespace hires::robot {

/// Limits of one way to drive. All >= 0.
struct MotionSet {
  double max_linear_velocity{0.55};       ///< [m/s]
  double max_angular_velocity{1.0};       ///< [rad/s]
  double max_linear_acceleration{2.5};    ///< [m/s^2]
  double max_angular_acceleration{3.2};   ///< [rad/s^2]
};

/// What the base's own controller does with velocity commands (PR2: pr2_base_controller at 1 kHz).
struct BaseControllerParams {
  MotionSet limits{1.0, 2.0, 2.0, 2.0};  ///< clips commands; ramps at these accelerations
  double max_linear_jerk{0.0};      ///< [m/s^3]; 0 means that acceleration may jump
  double command_timeout{0.2};      ///< [s] without a command after which it brakes to a stop
  double command_lag{0.0};          ///< [s] from a command's sending to its effect
  double loop_frequency{0.0};       ///< [rad/s] natural frequency of the velocity loop; 0: ideal
  double loop_damping{1.0};         ///< damping ratio of the velocity loop
  double pitch_compliance{0.0};     ///< [rad s^2/m] how far the base leans per acceleration
};

/// What cannot be read from a URDF: which link is what, how the base behaves, named motion sets and
/// postures. One YAML per robot, config/robots/<name>.yaml.
struct RobotProfile {
  std::string urdf;                ///< path, relative to the profile's folder
  std::string base_link;           ///< link whose pose in the plane the robot drives (base_footprint)
  std::string tray_link;           ///< link that carries loose objects
  geometry::Pose3 X_TO;            ///< where an object is put, in the tray link's frame
  std::string laser_link;          ///< planar laser for navigation, or empty
  geometry::Polygon footprint;     ///< in base_link [m]; from the collision shapes where not given
  double footprint_padding{0.015};  ///< [m]
  std::map<std::string, MotionSet> motion_sets;  ///< "slow", "fast"; lower-case names
  std::string default_motion_set;
  BaseControllerParams base_controller;
  JointPositions joints;           ///< posture while driving
  std::uint64_t hash{0};           ///< of all fields but `urdf`
};

/// A robot ready for use: model and profile that agree (links exist, joints within limits).
struct Robot {
  RobotModel model;
  RobotProfile profile;
  std::uint64_t hash() const;  ///< of both
};

/// Reads the profile and the URDF that it names.
/// @throws base::ConfigError naming file and key.
Robot LoadRobot(const std::string& profile_path);

/// A robot from a bare URDF, with what can be derived: base_link is the root; the tray is the link
/// whose name contains "tray" and has a collision shape, else the robot carries nothing; the
/// footprint is the convex hull of the collision shapes seen from above (0 .. 2 m).
/// Motion sets and base controller are those of RobotProfile's defaults (PR2).
Robot LoadRobotFromUrdf(const std::string& urdf_path);

}  // namespace hires::robot
