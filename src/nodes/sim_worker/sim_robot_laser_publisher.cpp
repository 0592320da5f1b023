#include "nodes/sim_worker/sim_robot_laser_publisher.h"

#include <tf2_msgs/TFMessage.h>

#include <utility>

#include "hires/ros/names/robot_topics.h"
#include "hires/ros/robot/robot_messages.h"
#include "nodes/sim_worker/is_heard.h"
#include "nodes/sim_worker/sensor_messages.h"

namespace hires_ros {
namespace {

using hires::sim_robot::kSensorTick;

constexpr double kTickTime = 0.001 * static_cast<double>(kSensorTick);  // [s]
constexpr std::uint32_t kScanQueue = 100;
constexpr std::uint32_t kCloudQueue = 2;

}  // namespace

SimRobotLaserPublisher::SimRobotLaserPublisher(const hires::control::RobotNames& names,
                                               const hires::robot::Robot& robot, bool tells_place,
                                               const hires::sim_robot::SimRobotLasers* lasers,
                                               ros::NodeHandle* nh)
    : lasers_(*lasers),
      robot_(robot),
      names_(names.sensors),
      odometry_frame_(names.odometry_frame) {
  const hires::control::SensorNames& topics = names_;
  if (lasers_.has_tray_laser() && !topics.tray_scan.empty()) {
    tray_scan_ = nh->advertise<sensor_msgs::LaserScan>(topics.tray_scan, kScanQueue);
  }
  if (!lasers_.has_tilting_laser()) return;
  sweep_.emplace(lasers_.num_scans_of_a_sweep());
  tf_ = nh->advertise<tf2_msgs::TFMessage>(kTransforms, kScanQueue);
  if (!topics.tilt_scan.empty()) {
    tilt_scan_ = nh->advertise<sensor_msgs::LaserScan>(topics.tilt_scan, kScanQueue);
  }
  if (tells_place && !topics.tilt_cloud.empty()) {
    tilt_cloud_ = nh->advertise<sensor_msgs::PointCloud2>(topics.tilt_cloud, kCloudQueue);
  }
}

void SimRobotLaserPublisher::AddTilt(const hires::sim_robot::SimRobotWorld& world,
                                     hires::robot::JointPositions* joints) const {
  if (!lasers_.has_tilting_laser()) return;
  (*joints)[robot_.profile.sensors.tilting_laser->joint] = lasers_.TiltPhase(world).angle;
}

std::vector<std::string> SimRobotLaserPublisher::PublishTick(
    const hires::sim_robot::SimRobotWorld& world, const ros::Time& stamp) {
  std::vector<std::string> topics;
  if (IsHeard(tray_scan_)) {
    sensor_msgs::LaserScan scan = ToMsg(lasers_.tray(), lasers_.TrayScan(world), kTickTime);
    scan.header.frame_id = lasers_.tray().link;
    scan.header.stamp = stamp;
    tray_scan_.publish(scan);
    topics.push_back(names_.tray_scan);
  }
  // A tick may be told of again.
  if ((sent_ && *sent_ != stamp) || !IsHeard(tilt_cloud_)) cloud_ = std::nullopt;
  if (cloud_) {
    sensor_msgs::PointCloud2 msg = ToMsg(*cloud_);
    msg.header.frame_id = odometry_frame_;
    msg.header.stamp = stamp;
    tilt_cloud_.publish(msg);
    sent_ = stamp;
    topics.push_back(names_.tilt_cloud);
  }
  return topics;
}

void SimRobotLaserPublisher::PublishLook(const hires::sim_robot::SimRobotWorld& world,
                                         const hires::sim_robot::SensorReadings& readings,
                                         const ros::Time& stamp) {
  const bool wants_cloud = IsHeard(tilt_cloud_);
  if (!lasers_.IsTiltDue(world) || (!wants_cloud && !IsHeard(tilt_scan_))) return;
  const std::vector<double> ranges = lasers_.TiltScan(world);
  sensor_msgs::LaserScan scan = ToMsg(lasers_.tilting(), ranges, lasers_.tilt_period());
  scan.header.frame_id = lasers_.tilting().link;
  scan.header.stamp = stamp;
  PublishTilt(world, stamp);
  if (IsHeard(tilt_scan_)) tilt_scan_.publish(scan);
  if (!wants_cloud) return;
  auto cloud = sweep_->Add(lasers_.TiltPhase(world), lasers_.tilting(), ranges,
                           lasers_.X_OTilt(world, readings));
  if (!cloud) return;
  cloud_ = std::move(cloud);
  sent_ = std::nullopt;
}

/// Ticks have their own; between them the joint may turn back, which tf would not know.
void SimRobotLaserPublisher::PublishTilt(const hires::sim_robot::SimRobotWorld& world,
                                         const ros::Time& stamp) {
  if (world.milliseconds() % kSensorTick == 0) return;
  const hires::robot::RobotModel& model = robot_.model;
  const std::string& joint = robot_.profile.sensors.tilting_laser->joint;
  const auto X_R = ForwardKinematics(model, {{joint, lasers_.TiltPhase(world).angle}});
  const int link = *FindLinkOf(model, joint), parent = model.links[link].joint->parent;
  tf2_msgs::TFMessage msg;
  msg.transforms.push_back(MakeTransform(model.links[parent].name, model.links[link].name,
                                         X_R[parent].Inverse() * X_R[link], stamp));
  tf_.publish(msg);
}

}  // namespace hires_ros
