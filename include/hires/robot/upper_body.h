#pragma once

#include <map>
#include <string>
#include <vector>

namespace hires::robot {

/// What an arm of a robot is made of: names of links and joints of its URDF, and its named
/// postures.
struct ArmProfile {
  std::vector<std::string> joints;  ///< from the shoulder to the wrist
  std::string tool_link;            ///< between the finger tips: what is brought to an object
  std::string palm_link;            ///< holds what is grasped
  std::string gripper_joint;        ///< [m] gap between the finger tips: the commanded one
  std::string finger_joint;         ///< [rad] the one that the other finger joints follow
  std::vector<std::string> left_finger_links, right_finger_links;  ///< whose touch makes a grasp
  /// Lower-case posture name ("armtuckedposture") -> joint positions in the order of `joints`.
  /// Several variants where one name stands for several: the first is the one that is moved to.
  std::map<std::string, std::vector<std::vector<double>>> postures;
  /// The variant that is moved to while the hand holds something, so that it stays upright.
  std::map<std::string, std::vector<double>> holding_postures;
  /// Lower-case name -> joint positions that motions between postures pass: "clear", "up",
  /// "approach" (folding and opening), "above" (on the way to carrying). No postures themselves.
  std::map<std::string, std::vector<double>> way_points;
};

/// Both grippers are alike. Gap and finger angle follow each other (GapOf, FingerAngleOf).
struct GripperProfile {
  double max_gap{0.09};            ///< [m]
  double max_finger_angle{0.548};  ///< [rad] at max_gap
  double finger_slant{0.062882};   ///< [rad] of the line from finger joint to tip, when closed
  double max_speed{0.05};          ///< [m/s] of the gap
  double force{50.0};              ///< [N] with which the fingers close at most
};

/// Everything above the base that moves. A robot without it drives only. Key `upper_body` of the
/// robot's YAML; read and checked against the URDF by LoadRobot.
struct UpperBodyProfile {
  std::map<std::string, ArmProfile> arms;  ///< by instance in lower case: leftarm1, rightarm1
  GripperProfile gripper;
  std::string torso_joint;
  std::map<std::string, double> torso_postures;  ///< lower-case name -> [m]
  std::string head_pan_joint, head_tilt_joint;
  std::string camera_link;                              ///< looks along its x axis
  double camera_width{1.0};                             ///< [rad] horizontal field of view
  double camera_height{0.785};                          ///< [rad] vertical
  double camera_min_range{0.4}, camera_max_range{3.5};  ///< [m]
  /// [rad/s^2] or [m/s^2] by joint; joints that are not named take `default_acceleration`.
  std::map<std::string, double> accelerations;
  double default_acceleration{2.0};
};

/// [rad/s^2] or [m/s^2] with which a joint may speed up and brake.
double AccelerationOf(const UpperBodyProfile& profile, const std::string& joint);

/// Joints that a group's trajectories may name: "torso", "head", or an arm by its instance in lower
/// case; empty for any other name.
std::vector<std::string> JointsOfGroup(const UpperBodyProfile& profile, const std::string& group);

}  // namespace hires::robot
