#include "nodes/sim_worker/sim_robot_motion_publisher.h"

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <nav_msgs/Odometry.h>

#include "hires/robot/posture.h"
#include "hires/ros/names/robot_topics.h"
#include "hires/ros/robot/robot_messages.h"
#include "hires/ros/values/geometry_messages.h"
#include "hires/ros/values/pose_messages.h"
#include "nodes/sim_worker/sensor_messages.h"

namespace hires_ros {
namespace {

constexpr std::uint32_t kMotionQueue = 6000;  // a minute of 100 Hz: see sim_robot_publisher.cpp

/// In which the wheels count; another one than that of the filter which joins them with the unit.
std::string WheelFrame(const std::string& odometry_frame) {
  return odometry_frame == "odom" ? "wheel_odom" : "odom";
}

Eigen::Quaterniond RotationInBase(const hires::robot::Robot& robot, const std::string& link) {
  const auto X_RL =
      hires::robot::ForwardKinematics(robot.model, hires::robot::PostureOf(robot, {}));
  const auto& model = robot.model;
  return (X_RL[*model.FindLink(robot.profile.base_link)].Inverse() * X_RL[*model.FindLink(link)])
      .rotation;
}

}  // namespace

SimRobotMotionPublisher::SimRobotMotionPublisher(const hires::control::RobotNames& names,
                                                 const hires::robot::Robot& robot, bool tells_place,
                                                 ros::NodeHandle* nh)
    : map_frame_(names.map_frame),
      odometry_frame_(tells_place ? names.odometry_frame : WheelFrame(names.odometry_frame)),
      base_frame_(robot.profile.base_link),
      inertia_frame_(robot.profile.sensors.inertial_unit_link),
      odometry_(nh->advertise<nav_msgs::Odometry>(names.odometry, kMotionQueue)) {
  if (tells_place) return;
  initial_pose_ = nh->advertise<geometry_msgs::PoseWithCovarianceStamped>(kInitialPose, 10);
  if (inertia_frame_.empty() || names.sensors.inertia.empty()) return;
  R_BI_ = RotationInBase(robot, inertia_frame_);
  inertia_ = nh->advertise<sensor_msgs::Imu>(names.sensors.inertia, kMotionQueue);
}

/// The unit first: a filter waits for it with the odometry.
void SimRobotMotionPublisher::Publish(const hires::sim_robot::SensorReadings& readings,
                                      const ros::Time& stamp) {
  if (R_BI_ && readings.inertia) {
    sensor_msgs::Imu inertia = ToMsg(*readings.inertia, *R_BI_);
    inertia.header.stamp = stamp;
    inertia.header.frame_id = inertia_frame_;
    inertia_.publish(inertia);
  }
  nav_msgs::Odometry odometry;
  odometry.header.stamp = stamp;
  odometry.header.frame_id = odometry_frame_;
  odometry.child_frame_id = base_frame_;
  odometry.pose.pose = ToMsg(hires::geometry::Lift(readings.odometry.X_OB));
  odometry.twist.twist = ToMsg(readings.odometry.V_B);
  odometry_.publish(odometry);
}

void SimRobotMotionPublisher::TellStart(const hires::sim_robot::SimRobotWorld& world,
                                        const ros::Time& stamp) {
  if (!initial_pose_) return;
  const std::uint32_t num_listeners = initial_pose_.getNumSubscribers();
  const bool is_one_new = num_listeners > num_told_;
  num_told_ = num_listeners;
  const auto start = is_one_new ? world.ToldStart() : std::nullopt;
  if (!start) return;
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = map_frame_;
  initial_pose_.publish(ToMsg(UncertainPose{start->X_MB, start->covariance}, header));
}

}  // namespace hires_ros
