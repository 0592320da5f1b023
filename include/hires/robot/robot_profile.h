#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hires/geometry/polygon.h"
#include "hires/geometry/pose.h"
#include "hires/robot/caster_params.h"
#include "hires/robot/extra_sensors.h"
#include "hires/robot/robot_model.h"
#include "hires/robot/upper_body.h"

namespace hires::robot {

/// Limits of one way to drive. All >= 0.
struct MotionSet {
  double max_linear_velocity{0.55};      ///< [m/s]
  double max_angular_velocity{1.0};      ///< [rad/s]
  double max_linear_acceleration{2.5};   ///< [m/s^2]
  double max_angular_acceleration{3.2};  ///< [rad/s^2]
  double max_linear_deceleration{0.0};   ///< [m/s^2]; 0: as the acceleration
  double max_angular_deceleration{0.0};  ///< [rad/s^2]; 0: as the acceleration

  double linear_deceleration() const {
    return max_linear_deceleration > 0.0 ? max_linear_deceleration : max_linear_acceleration;
  }
  double angular_deceleration() const {
    return max_angular_deceleration > 0.0 ? max_angular_deceleration : max_angular_acceleration;
  }
};

/// Where a base can drive to without turning first. Of one that cannot drive sideways the base_link
/// lies over the middle of the axle that keeps its direction.
enum class Drive {
  kOmnidirectional,  ///< forward and sideways: steered casters, mecanum or omni wheels
  kDifferential,     ///< two driven sides: forward, backward and turning, never sideways
  kCarLike,          ///< Ackermann steering: forward and backward, turning only while it drives
};

/// What the base's own controller does with velocity commands (PR2: pr2_base_controller at 1 kHz).
struct BaseControllerParams {
  Drive drive{Drive::kOmnidirectional};
  /// [m] of the circle that base_link drives on with the steering hard over. > 0 where the drive is
  /// kCarLike, else 0.
  double min_turning_radius{0.0};
  MotionSet limits{1.0, 2.0, 2.0, 2.0};  ///< clips commands; ramps at these accelerations
  double max_linear_jerk{0.0};           ///< [m/s^3]; 0 means that acceleration may jump
  double command_timeout{0.2};           ///< [s] without a command after which it brakes to a stop
  bool stops_at_timeout{false};          ///< then at once, without the ramp of a command
  double emergency_deceleration{0.0};    ///< [m/s^2] of the ramp after a timeout; 0: the limits'
  double command_lag{0.0};               ///< [s] from a command's sending to its effect
  /// Empty: the base follows by the velocity loop below.
  std::optional<CasterParams> casters;
  double loop_frequency{0.0};   ///< [rad/s] natural frequency of the velocity loop; 0: ideal
  double loop_damping{1.0};     ///< damping ratio of the velocity loop
  double sway_compliance{0.0};  ///< [rad s^2/m] how far the base leans per acceleration
  double sway_frequency{17.0};  ///< [rad/s] natural frequency of that leaning
  double sway_damping{0.2};     ///< its damping ratio
};

/// What cannot be read from a URDF: which link is what, how the base behaves, named motion sets and
/// postures. One YAML per robot, `config/robots/<name>.yaml`.
struct RobotProfile {
  std::string urdf;             ///< path, relative to the profile's folder
  std::string base_link;        ///< link whose pose in the plane the robot drives (base_footprint)
  std::string tray_link;        ///< link that carries loose objects, or empty
  geometry::Pose3 X_TO;         ///< where an object is put, in the tray link's frame
  std::string laser_link;       ///< planar laser for navigation, or empty
  geometry::Polygon footprint;  ///< in base_link [m]; from the collision shapes if empty in YAML
  double footprint_padding{0.015};  ///< [m]
  /// Lower-case names; at first the two sets of the dissertation's Table 5.1.
  std::map<std::string, MotionSet> motion_sets{{"fast", {0.55, 1.0, 2.5, 3.2}},
                                               {"slow", {0.30, 1.0, 1.4, 2.0}}};
  std::string default_motion_set{"fast"};
  BaseControllerParams base_controller;
  JointPositions joints;                       ///< posture while driving
  std::optional<UpperBodyProfile> upper_body;  ///< empty: nothing above the base moves
  ExtraSensors sensors;                        ///< which rollouts do not play
  std::uint64_t hash{0};                       ///< of all fields but `urdf` and `sensors`
};

/// A robot ready for use: model and profile that agree (links exist, joints within limits).
struct Robot {
  RobotModel model;
  RobotProfile profile;
  /// [m] of the frame that was named base_link, or is the root, over the floor, where the robot's
  /// shapes reach below it: base_link is then a link base_footprint below it, added where there was
  /// none. 0: base_link itself is on the floor.
  double base_height{0.0};
  /// What no file says and its drives rest on, one sentence each with what to write; for people.
  std::vector<std::string> assumed{};
  std::uint64_t hash() const;  ///< of both
};

/// The robot seen from above: the convex hull of its collision shapes from 0 to 2 m above the link
/// `base_link`, in that link's frame [m].
/// @throws base::ConfigError where no shape lies there, and as FrozenCollisions.
geometry::Polygon OutlineOf(const RobotModel& model, const std::string& base_link,
                            const JointPositions& joints);

/// What drives, seen from above: the same of all links but those that torso, neck and arms carry,
/// joints in the driving posture; the footprint where none of these has a shape. Where a footprint
/// has room for arms as well, this is the smaller.
/// @throws base::ConfigError as FrozenCollisions.
geometry::Polygon BaseOutlineOf(const Robot& robot);

/// [m] of the base's laser above base_link, joints in the driving posture; none: it has no laser.
/// @throws base::ConfigError as ForwardKinematics.
std::optional<double> LaserHeight(const Robot& robot);

/// Reads the profile and the URDF that it names, which must be there, and so must, where there are
/// several `motion_sets`, `default_motion_set`. Of the others, base_link, tray_link, object_on_tray
/// and base_controller.drive are derived as below where they are left out, its limits are the
/// largest of the motion sets, those of `navigation` (a parameter file of Nav2) are their
/// decelerations, and an empty footprint is the hull from above, joints in the driving
/// posture.
/// @throws base::ConfigError naming file and key; all missing keys at once.
Robot LoadRobot(const std::string& profile_path);

/// A robot from a bare URDF, with what can be derived: base_link is the root; the tray is the link
/// whose name contains "tray" (case ignored) and has a collision shape, the largest one seen from
/// above where several do, and objects stand on the middle of its top, or of its largest free part
/// where something of the robot takes the middle; without such a link the robot carries nothing.
/// Where shapes reach below the root, the lowest one is on the floor (see Robot::base_height). The
/// footprint is the convex hull of the collision shapes seen from above, up to 2 m over the floor,
/// joints at rest, padded as RobotProfile's default.
/// Motion sets and base controller are those of RobotProfile's defaults (PR2); how it drives, and
/// how sharply a car-like one turns, is guessed from its wheels, and logged.
/// @throws base::ConfigError as LoadRobotModel, and if there is no collision shape in that band.
Robot LoadRobotFromUrdf(const std::string& urdf_path);

}  // namespace hires::robot
