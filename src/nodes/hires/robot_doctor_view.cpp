#include "nodes/hires/robot_doctor_view.h"

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/Twist.h>
#include <nav_msgs/OccupancyGrid.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/LaserScan.h>
#include <std_msgs/Bool.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <algorithm>

#include "hires/base/text.h"
#include "hires/ros/pr2_gripper_command.h"

namespace hires_ros {
namespace {

using hires::robot::RobotProfile;

/// [s] The base guard stops the base when the pose or the scan is older.
constexpr double kOldestPose = 0.3;
/// [Hz] at which the middle layer decides; what it looks at should come as often.
constexpr double kDecisionRate = 20.0;
/// [Hz] The scan may miss every second of a 20 Hz laser's turns.
constexpr double kLowestScanRate = 10.0;

template <typename Message>
WantedTopic Want(const std::string& what, const std::string& name, const std::string& remedy) {
  WantedTopic topic;
  topic.what = what;
  topic.name = Absolute(name);
  topic.type = ros::message_traits::datatype<Message>();
  topic.md5 = ros::message_traits::md5sum<Message>();
  topic.is_stamped = ros::message_traits::hasHeader<Message>();
  topic.remedy = remedy;
  return topic;
}

WantedTopic Often(WantedTopic topic, double min_rate) {
  topic.min_rate = min_rate;
  topic.max_age = kOldestPose;
  return topic;
}

constexpr char kStartRobot[] =
    "start the robot (on a PR2: robot.launch by `robot start`); if it calls the topic otherwise, "
    "say so in the names file";

void AddArm(const hires::robot::ArmProfile& arm, std::vector<JointChoice>* joints) {
  for (const std::string& joint : arm.joints) joints->push_back({joint});
  if (!arm.gripper_joint.empty()) joints->push_back({arm.gripper_joint, arm.finger_joint});
}

}  // namespace

std::string Absolute(const std::string& name) {
  return !name.empty() && name.front() == '/' ? name : "/" + name;
}

std::vector<WantedTopic> TopicsOf(const hires::control::RobotNames& names) {
  std::vector<WantedTopic> topics{
      Often(Want<nav_msgs::Odometry>("odometry", names.odometry, kStartRobot), kDecisionRate),
      Often(Want<sensor_msgs::JointState>("joint states", names.joint_states, kStartRobot),
            kDecisionRate),
      Often(Want<sensor_msgs::LaserScan>("base scan", names.base_scan, kStartRobot),
            kLowestScanRate),
      Want<geometry_msgs::PoseWithCovarianceStamped>(
          "localisation", names.localisation,
          "start amcl with the map, and give the first pose (RViz: 2D Pose Estimate)")};
  if (!names.motors_halted.empty()) {
    topics.push_back(Want<std_msgs::Bool>(
        "motors", names.motors_halted,
        "start the robot; a robot that does not tell needs an empty motors_halted in the names "
        "file"));
  }
  return topics;
}

WantedTopic MapOf(const hires::control::RobotNames& names) {
  return Want<nav_msgs::OccupancyGrid>("map", names.map,
                                       "start map_server with the map of this building");
}

std::vector<WantedListener> ListenersOf(const hires::control::RobotNames& names) {
  std::vector<WantedListener> listeners{
      {"base", Absolute(names.base_command), ros::message_traits::datatype<geometry_msgs::Twist>(),
       "start what leads velocities to the base (on a PR2: the multiplexer of the teleop launch "
       "file, in front of base_controller/command)"}};
  constexpr char kController[] =
      "start its controller (on a PR2: `rosrun pr2_controller_manager pr2_controller_manager "
      "start NAME`)";
  for (const auto& [group, topic] : names.trajectories) {
    listeners.push_back({"joints " + group, Absolute(topic),
                         ros::message_traits::datatype<trajectory_msgs::JointTrajectory>(),
                         kController});
  }
  for (const auto& [arm, topic] : names.grippers) {
    listeners.push_back({"gripper of " + arm, Absolute(topic),
                         ros::message_traits::datatype<Pr2GripperCommand>(), kController});
  }
  return listeners;
}

std::vector<std::string> LinksOf(const RobotProfile& profile) {
  std::vector<std::string> links{profile.tray_link, profile.laser_link};
  if (profile.upper_body) {
    links.push_back(profile.upper_body->camera_link);
    for (const auto& [name, arm] : profile.upper_body->arms) {
      links.insert(links.end(), {arm.palm_link, arm.tool_link});
    }
  }
  links.erase(std::remove(links.begin(), links.end(), ""), links.end());
  return links;
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

double SeenMessages::rate() const {
  return count > 1 && last > first ? (count - 1) / (last - first) : 0.0;
}

std::optional<double> SeenMessages::age() const {
  if (ages.empty()) return std::nullopt;
  std::vector<double> sorted = ages;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

std::string SeenNode::host() const {
  const auto endpoint = hires::relay::ParseUri(uri);
  return endpoint ? endpoint->host : "";
}

const SeenTopic* RobotView::FindTopic(const std::string& name) const {
  const auto it = topics.find(name);
  return it == topics.end() ? nullptr : &it->second;
}

bool RobotView::IsHere(const std::string& host) const {
  if (hires::relay::IsLoopback(host) || this_host.count(hires::base::ToLower(host)) > 0) {
    return true;
  }
  const auto known = addresses.find(host);
  return known != addresses.end() &&
         std::any_of(known->second.begin(), known->second.end(),
                     [&](const std::string& address) { return this_host.count(address) > 0; });
}

}  // namespace hires_ros
