#include "nodes/middle_layer/robot_inputs.h"

#include "hires/base/error.h"
#include "hires/ros/names/robot_topics.h"
#include "hires/ros/perception/cloud_messages.h"
#include "hires/ros/robot/scan_messages.h"

namespace hires_ros {
namespace {

hires::geometry::Polygon FootprintOf(const hires::imagination::ImaginationSetup& setup) {
  const hires::robot::RobotProfile& profile = setup.scene->robot.profile;
  return hires::geometry::Padded(profile.footprint, profile.footprint_padding);
}

}  // namespace

RobotInputs::RobotInputs(const hires::imagination::ImaginationSetup& setup,
                         const hires::control::RobotNames& names,
                         const hires::sensing::ScanParams& scan, Hooks hooks, ros::NodeHandle* nh)
    : names_(names),
      hooks_(std::move(hooks)),
      sensors_({setup.scene, &setup.scene->robot}, setup.scene->in_camera(), names, setup.sensing),
      observations_(&sensors_.state(), {setup.skills->driving->costmap, FootprintOf(setup), scan},
                    hires::robot::BaseOutlineOf(setup.scene->robot)) {
  if (setup.sensing.ground.is_enabled && !names.sensors.tilt_cloud.empty()) {
    ground_.emplace(&sensors_.state(),
                    std::shared_ptr<const hires::robot::Robot>(setup.scene, &setup.scene->robot),
                    setup.skills->driving->costmap, setup.sensing.ground);
  }
  Subscribe(nh);
}

void RobotInputs::Subscribe(ros::NodeHandle* nh) {
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  const auto add = [&](ros::Subscriber subscriber) { subscribers_.push_back(subscriber); };
  add(nh->subscribe(names_.odometry, 100, &RobotInputs::OnOdometry, this, hints));
  add(nh->subscribe(names_.joint_states, 100, &RobotInputs::OnJoints, this, hints));
  const auto on_transforms = [this](bool are_static) {
    return boost::function<void(const tf2_msgs::TFMessage&)>(
        [this, are_static](const tf2_msgs::TFMessage& msg) { OnTransforms(msg, are_static); });
  };
  add(nh->subscribe<tf2_msgs::TFMessage>(kTransforms, 100, on_transforms(false),
                                         ros::VoidConstPtr(), hints));
  add(nh->subscribe<tf2_msgs::TFMessage>(kStaticTransforms, 100, on_transforms(true)));
  add(nh->subscribe(names_.base_scan, 10, &RobotInputs::OnScan, this, hints));
  if (!names_.localisation.empty())
    add(nh->subscribe(names_.localisation, 10, &RobotInputs::OnLocalisation, this, hints));
  if (ground_) {
    add(nh->subscribe(names_.sensors.tilt_cloud, 2, &RobotInputs::OnCloud, this, hints));
  }
  if (!names_.sensors.tray_scan.empty()) {
    add(nh->subscribe(names_.sensors.tray_scan, 10, &RobotInputs::OnTrayScan, this, hints));
  }
  add(nh->subscribe(kDetections, 10, &RobotInputs::OnDetections, this, hints));
  add(nh->subscribe(kKnownObjects, 10, &SensorReceiver::OnKnownObjects, &sensors_, hints));
}

void RobotInputs::OnOdometry(const nav_msgs::Odometry& msg) {
  sensors_.OnOdometry(msg);
  if (num_restarts_ != state().num_restarts()) {
    num_restarts_ = state().num_restarts();
    hooks_.clock_restarted();
  }
  hooks_.arrived(names_.odometry, msg.header.stamp.toSec());
  // Nobody waits for clouds that nobody hears.
  if (!ground_) hooks_.arrived(names_.sensors.tilt_cloud, msg.header.stamp.toSec());
}

void RobotInputs::OnJoints(const sensor_msgs::JointState& msg) {
  sensors_.OnJoints(msg);
  hooks_.arrived(names_.joint_states, msg.header.stamp.toSec());
}

void RobotInputs::OnTransforms(const tf2_msgs::TFMessage& msg, bool are_static) {
  sensors_.OnTransforms(msg, are_static);
  if (const auto localised = state().LocalisedUntil()) hooks_.arrived(kTransforms, *localised);
}

void RobotInputs::OnScan(const sensor_msgs::LaserScan& msg) {
  const double stamp = msg.header.stamp.toSec();
  const auto receipt = observations_.OnScan(stamp, msg.header.frame_id, ReadingOf(msg));
  if (receipt.is_bad()) sensors_.Refuse(names_.base_scan, hires::sensing::ToString(receipt));
  hooks_.arrived(names_.base_scan, stamp);
}

/// A robot that is not sure of its place stops. That its numbers are none makes it unsure, too.
void RobotInputs::OnLocalisation(const geometry_msgs::PoseWithCovarianceStamped& msg) {
  const auto& of = msg.pose.covariance;  // of x, y, z, roll, pitch, yaw; row by row
  Eigen::Matrix3d covariance;
  covariance << of[0], of[1], of[5], of[6], of[7], of[11], of[30], of[31], of[35];
  observations_.OnLocalised(covariance);
}

void RobotInputs::OnCloud(const sensor_msgs::PointCloud2& msg) {
  try {
    const auto receipt =
        ground_->OnCloud(msg.header.stamp.toSec(), msg.header.frame_id, FromMsg(msg));
    if (receipt.is_bad())
      sensors_.Refuse(names_.sensors.tilt_cloud, hires::sensing::ToString(receipt));
  } catch (const hires::base::ConfigError& error) {
    sensors_.Refuse(names_.sensors.tilt_cloud, error.what());
  }
  hooks_.arrived(names_.sensors.tilt_cloud, msg.header.stamp.toSec());
}

void RobotInputs::OnTrayScan(const sensor_msgs::LaserScan& msg) {
  sensors_.OnTrayScan(msg);
  hooks_.arrived(names_.sensors.tray_scan, msg.header.stamp.toSec());
}

void RobotInputs::OnDetections(const hires::Detections& msg) {
  sensors_.OnDetections(msg);
  hooks_.arrived(kDetections, msg.header.stamp.toSec());
}

hires::robot::Observation RobotInputs::ObservationOf(const hires::sensing::RobotEstimate& now) {
  hires::robot::Observation seen = observations_.Observe(now);
  const hires::sensing::Receipt& scan = observations_.scan_receipt();
  if (scan.is_bad()) sensors_.Warn(names_.base_scan, hires::sensing::ToString(scan));
  if (ground_) {
    const auto& on_the_floor = ground_->Obstacles(now);
    seen.obstacles_M.insert(seen.obstacles_M.end(), on_the_floor.begin(), on_the_floor.end());
    if (ground_->receipt().is_bad())
      sensors_.Warn(names_.sensors.tilt_cloud, hires::sensing::ToString(ground_->receipt()));
  }
  sensors_.Update(now);
  if (const hires::sensing::ObjectEstimator* objects = sensors_.objects()) {
    seen.objects = objects->memory().Known(now.Body());
    seen.num_newcomers = objects->memory().num_newcomers();
  }
  return seen;
}

}  // namespace hires_ros
