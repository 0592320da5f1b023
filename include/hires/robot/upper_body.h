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
  std::string finger_joint;         ///< the one that the other finger joints follow
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

/// What of the gripper matters round an object. The tool's x axis points out between the fingers,
/// which open along y. Defaults: PR2, from the extents of its meshes.
struct FingerShape {
  double tip_reach{0.02};         ///< [m] the tips reach beyond the tool's origin
  double palm_distance{0.0546};   ///< [m] from the tool's origin back to the palm's front
  double pad_half_height{0.011};  ///< [m] of the tips, along the tool's z
  double half_height{0.028};      ///< [m] of the fingers, likewise
  double max_gap_used{0.085};  ///< [m] of an object's width: leaves room to get the fingers round
  /// Open fingers stand like a V. Their inner faces, drawn on to the tool's origin, are
  /// `open_width` apart there and `narrowing` less for each metre towards the palm (PR2's finger
  /// boxes turned by 0.548 rad; 0 where they stay parallel): how deep a wide object fits between.
  double open_width{0.125};  ///< [m]
  double narrowing{1.22};    ///< [m/m]
};

/// How the fingers open.
enum class FingerMotion {
  kSwinging,  ///< on links, the tips staying parallel (PR2); the finger joint is an angle
  kSliding    ///< each along a straight line (parallel jaws); the finger joint is half the gap
};

/// All grippers of a robot are alike. Gap and finger joint follow each other (GapOf,
/// FingerPositionOf).
struct GripperProfile {
  FingerMotion fingers{FingerMotion::kSwinging};
  double max_gap{0.09};            ///< [m]
  double max_finger_angle{0.548};  ///< [rad] at max_gap, of swinging fingers
  double finger_slant{0.062882};   ///< [rad] of the line from finger joint to tip, when closed
  double max_speed{0.05};          ///< [m/s] of the gap
  double force{50.0};              ///< [N] with which the fingers close at most
  FingerShape shape;
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
