#include "nodes/sim_worker/robot_broadcaster.h"

#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/JointState.h>
#include <visualization_msgs/MarkerArray.h>

#include "hires/ros/names/topic_names.h"
#include "hires/ros/robot/robot_messages.h"
#include "hires/ros/values/geometry_messages.h"

namespace hires_ros {
namespace {

using hires::geometry::Pose3;

}  // namespace

RobotBroadcaster::RobotBroadcaster(std::shared_ptr<const hires::simulation::Scene> scene,
                                   const hires::world::StandingCriterion& standing, int index,
                                   double rate, ros::NodeHandle* nh)
    : scene_(std::move(scene)),
      period_(1.0 / rate),
      clock_(nh->advertise<rosgraph_msgs::Clock>("/clock", 10)),
      odom_(nh->advertise<nav_msgs::Odometry>("base_odometry/odom", 10)),
      joints_(nh->advertise<sensor_msgs::JointState>("joint_states", 10)),
      markers_(
          nh->advertise<visualization_msgs::MarkerArray>(WorkerName(index, kWorkerMarkers), 10)),
      trace_(index, standing) {
  PublishLinks(SimulatedTime(0.0));
}

ros::Time RobotBroadcaster::SimulatedTime(double in_rollout) const {
  return ros::Time(clock_base_ + in_rollout);
}

bool RobotBroadcaster::IsDue() {
  const auto now = std::chrono::steady_clock::now();
  if (now - last_ < period_) return false;
  last_ = now;
  return true;
}

void RobotBroadcaster::BeginRollout() {
  clock_base_ += in_rollout_;
  in_rollout_ = 0.0;
  trace_.Clear();
}

void RobotBroadcaster::PublishIdle() {
  const auto now = std::chrono::steady_clock::now();
  const auto before = last_;
  if (!IsDue()) return;
  const double idle = std::chrono::duration<double>(now - before).count();
  clock_base_ += std::min(idle, 0.2);  // `before` may be long ago, or never
  PublishClock(SimulatedTime(in_rollout_));
}

void RobotBroadcaster::Publish(const hires::simulation::RobotSimulator& simulator) {
  in_rollout_ = simulator.time();
  trace_.Add(simulator);
  if (!IsDue()) return;
  const ros::Time stamp = SimulatedTime(in_rollout_);
  PublishClock(stamp);
  PublishRobot(simulator, stamp);
  if (markers_.getNumSubscribers() > 0) markers_.publish(trace_.Draw(simulator));
}

void RobotBroadcaster::PublishClock(const ros::Time& time) {
  rosgraph_msgs::Clock clock;
  clock.clock = time;
  clock_.publish(clock);
}

void RobotBroadcaster::PublishRobot(const hires::simulation::RobotSimulator& simulator,
                                    const ros::Time& stamp) {
  const Pose3 X_MB = simulator.X_MB();
  const std::string& base = scene_->robot.profile.base_link;
  tf_.sendTransform(std::vector<geometry_msgs::TransformStamped>{
      MakeTransform("map", "odom_combined", {}, stamp),
      MakeTransform("odom_combined", base, X_MB, stamp)});
  nav_msgs::Odometry odom;
  odom.header.frame_id = "odom_combined";
  odom.header.stamp = stamp;
  odom.child_frame_id = base;
  odom.pose.pose = ToMsg(X_MB);
  const hires::geometry::Twist2& V_B = simulator.base().V_B;
  odom.twist.twist.linear.x = V_B.vx;
  odom.twist.twist.linear.y = V_B.vy;
  odom.twist.twist.angular.z = V_B.wz;
  odom_.publish(odom);
  sensor_msgs::JointState joints;
  joints.header.stamp = stamp;
  for (const auto& [name, position] : scene_->robot.profile.joints) {
    joints.name.push_back(name);
    joints.position.push_back(position);
  }
  joints_.publish(joints);
}

void RobotBroadcaster::PublishLinks(const ros::Time& stamp) {
  static_tf_.sendTransform(LinkTransforms(scene_->robot, scene_->robot.profile.joints, stamp));
}

}  // namespace hires_ros
