// What stands around the guard of the base, each part a process of its own that tests can stop:
//   base_guard_peer robot             a base that follows navigation/cmd_vel; odometry and its
//   frame base_guard_peer localiser         map to odometry frame base_guard_peer scanner the base
//   laser base_guard_peer requester ID      leave to drive, at 20 Hz base_guard_peer commander VX
//   WZ   velocities, at 20 Hz
#include <geometry_msgs/Twist.h>
#include <hires/BaseRequest.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <sensor_msgs/LaserScan.h>
#include <tf2_msgs/TFMessage.h>

#include <chrono>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include "hires/ros/names/robot_topics.h"
#include "hires/ros/robot/robot_messages.h"
#include "hires/simulation/base_drive.h"

namespace {

using hires::simulation::BaseDrive;

/// Calls `work` so often per second, on the steady clock, until ROS ends.
void Repeat(ros::NodeHandle* nh, double rate, const std::function<void()>& work) {
  const ros::SteadyTimer timer = nh->createSteadyTimer(
      ros::WallDuration(1.0 / rate), [&](const ros::SteadyTimerEvent&) { work(); });
  ros::spin();
}

tf2_msgs::TFMessage Transform(const std::string& parent, const std::string& child,
                              const hires::geometry::Pose2& X_PC) {
  tf2_msgs::TFMessage msg;
  msg.transforms.push_back(
      hires_ros::MakeTransform(parent, child, hires::geometry::Lift(X_PC), ros::Time::now()));
  return msg;
}

/// A PR2's base behind its controller, in steps of 1 ms.
class Robot {
 public:
  explicit Robot(ros::NodeHandle* nh)
      : drive_({}, {}),
        odometry_(nh->advertise<nav_msgs::Odometry>("base_odometry/odom", 1)),
        transforms_(nh->advertise<tf2_msgs::TFMessage>(hires_ros::kTransforms, 10)),
        commands_(nh->subscribe<geometry_msgs::Twist>(
            "navigation/cmd_vel", 10,
            boost::function<void(const geometry_msgs::Twist&)>([this](const auto& msg) {
              CatchUp();
              drive_.Send(hires_ros::FromMsg(msg, "navigation/cmd_vel"), time_);
            }))) {}

  void Tell() {
    CatchUp();
    const hires::simulation::BaseMotion& motion = drive_.motion();
    nav_msgs::Odometry msg;
    msg.header.frame_id = "odom_combined";
    msg.header.stamp = ros::Time::now();
    msg.child_frame_id = "base_footprint";
    msg.pose.pose.position.x = motion.X_MB.x;
    msg.pose.pose.position.y = motion.X_MB.y;
    msg.pose.pose.orientation.w = 1.0;  // nobody asks where it looks
    msg.twist.twist = hires_ros::ToMsg(motion.V_B);
    odometry_.publish(msg);
    transforms_.publish(Transform("odom_combined", "base_footprint", motion.X_MB));
  }

 private:
  using Steady = std::chrono::steady_clock;

  void CatchUp() {
    const double now = std::chrono::duration<double>(Steady::now() - begin_).count();
    for (; time_ < now; time_ += 0.001) drive_.Step(time_, 0.001, 0.0);
  }

  BaseDrive drive_;
  double time_{0.0};  // [s]
  const Steady::time_point begin_{Steady::now()};
  ros::Publisher odometry_, transforms_;
  ros::Subscriber commands_;
};

int Localise(ros::NodeHandle* nh) {
  auto transforms = nh->advertise<tf2_msgs::TFMessage>(hires_ros::kTransforms, 10);
  Repeat(nh, 20.0, [&] { transforms.publish(Transform("map", "odom_combined", {})); });
  return 0;
}

int Scan(ros::NodeHandle* nh) {
  auto scans = nh->advertise<sensor_msgs::LaserScan>("base_scan", 1);
  Repeat(nh, 20.0, [&] {
    sensor_msgs::LaserScan msg;
    msg.header.stamp = ros::Time::now();
    msg.header.frame_id = "base_laser_link";
    scans.publish(msg);
  });
  return 0;
}

int Ask(ros::NodeHandle* nh, const std::string& id) {
  hires::BaseRequest msg;
  msg.id = std::stoull(id);
  msg.set_name = "fast";
  msg.max_linear_velocity = 0.4;
  msg.max_angular_velocity = 1.0;
  msg.max_linear_acceleration = 2.5;
  msg.max_angular_acceleration = 3.2;
  msg.max_braking = 1.0;
  msg.max_braking_jerk = 3.0;
  auto requests = nh->advertise<hires::BaseRequest>(hires_ros::kGuardRequest, 1);
  Repeat(nh, 20.0, [&] {
    msg.header.stamp = ros::Time::now();
    requests.publish(msg);
  });
  return 0;
}

int Drive(ros::NodeHandle* nh, const std::string& vx, const std::string& wz) {
  const hires::geometry::Twist2 V_B{std::stod(vx), 0.0, std::stod(wz)};
  auto commands = nh->advertise<geometry_msgs::Twist>(hires_ros::kGuardCommand, 1);
  Repeat(nh, 20.0, [&] { commands.publish(hires_ros::ToMsg(V_B)); });
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "base_guard_peer", ros::init_options::AnonymousName);
  const std::vector<std::string> words(argv + 1, argv + argc);
  const std::string role = words.empty() ? "" : words[0];
  ros::NodeHandle nh;
  if (role == "localiser") return Localise(&nh);
  if (role == "scanner") return Scan(&nh);
  if (role == "requester" && words.size() == 2) return Ask(&nh, words[1]);
  if (role == "commander" && words.size() == 3) return Drive(&nh, words[1], words[2]);
  if (role != "robot") {
    std::cerr << "base_guard_peer: wanted robot, localiser, scanner, requester ID or commander VX "
                 "WZ\n";
    return 1;
  }
  Robot robot(&nh);
  Repeat(&nh, 100.0, [&] { robot.Tell(); });
  return 0;
}
