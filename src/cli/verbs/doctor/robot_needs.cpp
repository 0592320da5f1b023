#include "cli/verbs/doctor/robot_needs.h"

#include <algorithm>

namespace hires::cli {
namespace {

using hires::robot::RobotProfile;

/// [Hz] at which the middle layer decides; what it looks at should come as often.
constexpr double kDecisionRate = 20.0;
/// [Hz] The scan may miss every second of a 20 Hz laser's turns.
constexpr double kLowestScanRate = 10.0;

WantedTopic Want(const std::string& what, const std::string& name, const MessageType& type,
                 const std::string& remedy) {
  WantedTopic topic;
  topic.what = what;
  topic.name = Absolute(name);
  topic.type = type.name;
  topic.md5 = type.md5;
  topic.is_stamped = type.has_header;
  topic.remedy = remedy;
  return topic;
}

WantedTopic Often(WantedTopic topic, double min_rate, double max_age) {
  topic.min_rate = min_rate;
  topic.max_age = max_age;
  return topic;
}

constexpr char kStartRobot[] =
    "start the robot (on a PR2: robot.launch by `robot start`); if it calls the topic otherwise, "
    "say so in the names file";

void AddArm(const hires::robot::ArmProfile& arm, std::vector<JointChoice>* joints) {
  for (const std::string& joint : arm.joints) joints->push_back({joint});
  if (!arm.gripper_joint.empty()) joints->push_back({arm.gripper_joint, arm.finger_joint});
}

std::vector<WantedTopic> TopicsOf(const hires::control::RobotNames& names,
                                  const RobotMessageTypes& types,
                                  const navigation::BaseGuardParams& guard) {
  std::vector<WantedTopic> topics{
      Often(Want("odometry", names.odometry, types.odometry, kStartRobot), kDecisionRate,
            guard.pose_patience),
      Often(Want("joint states", names.joint_states, types.joint_states, kStartRobot),
            kDecisionRate, guard.pose_patience),
      Often(Want("base scan", names.base_scan, types.scan, kStartRobot), kLowestScanRate,
            guard.scan_patience),
      Want("localisation", names.localisation, types.localisation,
           "start amcl with the map, and give the first pose (RViz: 2D Pose Estimate)")};
  if (!names.motors_halted.empty()) {
    topics.push_back(Want("motors", names.motors_halted, types.motors_halted,
                          "start the robot; a robot that does not tell needs an empty "
                          "motors_halted in the names file"));
  }
  return topics;
}

std::vector<WantedListener> ListenersOf(const hires::control::RobotNames& names,
                                        const RobotMessageTypes& types) {
  std::vector<WantedListener> listeners{
      {"base", Absolute(names.base_command), types.base_command.name,
       "start what leads velocities to the base (on a PR2: the multiplexer of the teleop launch "
       "file, in front of base_controller/command)"}};
  constexpr char kController[] =
      "start its controller (on a PR2: `rosrun pr2_controller_manager pr2_controller_manager "
      "start NAME`)";
  using control::GripperInterface;
  using control::TrajectoryInterface;
  const MessageType& trajectory =
      names.trajectory_interface == TrajectoryInterface::kFollowJointTrajectory
          ? types.trajectory_goal
          : types.trajectory;
  for (const auto& [group, topic] : names.trajectories) {
    listeners.push_back({"joints " + group, Absolute(topic), trajectory.name, kController});
  }
  const MessageType& gripper = names.gripper_interface == GripperInterface::kGripperCommand
                                   ? types.gripper_goal
                                   : types.gripper;
  for (const auto& [arm, topic] : names.grippers) {
    listeners.push_back({"gripper of " + arm, Absolute(topic), gripper.name, kController});
  }
  return listeners;
}

}  // namespace

std::string Absolute(const std::string& name) {
  return !name.empty() && name.front() == '/' ? name : "/" + name;
}

std::vector<WantedTopic> RobotNeeds::all_topics() const {
  std::vector<WantedTopic> all = topics;
  all.push_back(map);
  return all;
}

RobotNeeds NeedsOf(const hires::control::RobotNames& names, const RobotMessageTypes& types,
                   const navigation::BaseGuardParams& guard) {
  return {names, TopicsOf(names, types, guard),
          Want("map", names.map, types.map, "start map_server with the map of this building"),
          ListenersOf(names, types), guard.pose_patience};
}

std::vector<std::string> LinksOf(const RobotProfile& profile) {
  std::vector<std::string> links{profile.tray_link, profile.laser_link};
  if (profile.upper_body) {
    links.push_back(profile.upper_body->camera_link);
    for (const auto& [name, arm] : profile.upper_body->arms) {
      links.insert(links.end(), {arm.palm_link, arm.tool_link});
    }
  }
  std::vector<std::string> once;  // a gripper may be palm and tool
  for (const std::string& link : links) {
    const bool is_new = std::find(once.begin(), once.end(), link) == once.end();
    if (!link.empty() && is_new) once.push_back(link);
  }
  return once;
}

std::vector<JointChoice> JointsOf(const RobotProfile& profile) {
  std::vector<JointChoice> joints;
  if (!profile.upper_body) {
    for (const auto& [name, position] : profile.joints) joints.push_back({name});
    return joints;
  }
  for (const auto& [name, arm] : profile.upper_body->arms) AddArm(arm, &joints);
  for (const std::string& name :
       {profile.upper_body->torso_joint, profile.upper_body->head_pan_joint,
        profile.upper_body->head_tilt_joint}) {
    if (!name.empty()) joints.push_back({name});
  }
  return joints;
}

}  // namespace hires::cli
