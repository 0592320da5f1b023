#pragma once

#include <map>
#include <string>

/// What a PR2 calls its topics; relative, so that a launch file can put them elsewhere.
namespace hires_ros {

constexpr char kBaseCommand[] = "base_controller/command";
constexpr char kOdometry[] = "base_odometry/odom";
constexpr char kJointStates[] = "joint_states";
constexpr char kAmclPose[] = "amcl_pose";
constexpr char kBaseScan[] = "base_scan";
constexpr char kTransforms[] = "/tf";
constexpr char kMapFrame[] = "map";
constexpr char kOdometryFrame[] = "odom_combined";

constexpr char kDetections[] = "detections";       ///< what the head's camera recognises
constexpr char kKnownObjects[] = "known_objects";  ///< what is remembered of it
constexpr char kExecuteAction[] = "execute_action";

/// The simulated robot and the middle layer take turns by these.
constexpr char kLockstepTick[] = "lockstep/tick";
constexpr char kLockstepAck[] = "lockstep/ack";

/// Group of joints -> topic of its trajectory controller.
inline const std::map<std::string, std::string>& TrajectoryTopics() {
  static const std::map<std::string, std::string> topics{
      {"leftarm1", "l_arm_controller/command"},
      {"rightarm1", "r_arm_controller/command"},
      {"torso", "torso_controller/command"},
      {"head", "head_traj_controller/command"},
  };
  return topics;
}

/// Arm -> topic of its gripper's controller.
inline const std::map<std::string, std::string>& GripperTopics() {
  static const std::map<std::string, std::string> topics{
      {"leftarm1", "l_gripper_controller/command"},
      {"rightarm1", "r_gripper_controller/command"},
  };
  return topics;
}

}  // namespace hires_ros
