#include "nodes/odometry_filter/odometry_filter_node.h"

#include <fmt/format.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/process.h"
#include "hires/ros/names/robot_topics.h"
#include "hires/ros/robot/robot_messages.h"
#include "hires/ros/values/geometry_messages.h"
#include "hires/ros/values/pose_messages.h"

namespace hires_ros {
namespace {

using hires::base::ConfigError;
using hires::localisation::FilterOutcome;

constexpr char kOdometry[] = "odom";
constexpr char kInertia[] = "imu_data";
constexpr std::size_t kMostUnplaced = 1000;  // readings: 10 s at 100 Hz
constexpr double kJumpBack = 1.0;  // [s] by which time goes back where its clock began again

/// Whether a reading of which that became is used in some way.
bool IsUsed(FilterOutcome outcome) {
  return outcome != FilterOutcome::kNotFinite && outcome != FilterOutcome::kLate &&
         outcome != FilterOutcome::kTooMany;
}

/// What a unit does not measure has a covariance that begins with -1 (REP-145).
bool TellsOrientation(const sensor_msgs::Imu& msg) {
  return !(msg.orientation_covariance[0] < 0.0);
}

/// @param X_BI  unit in the base
hires::localisation::RobotLog::Inertia ReadingOf(const sensor_msgs::Imu& msg,
                                                 const hires::geometry::Pose3& X_BI) {
  const geometry_msgs::Vector3& w = msg.angular_velocity;
  hires::localisation::RobotLog::Inertia reading;
  reading.time = msg.header.stamp.toSec();
  reading.yaw_rate = (X_BI.rotation * Eigen::Vector3d(w.x, w.y, w.z)).z();
  if (!TellsOrientation(msg)) return reading;
  geometry_msgs::Pose pose;
  pose.orientation = msg.orientation;
  reading.yaw = hires::geometry::YawOf((FromMsg(pose) * X_BI.Inverse()).rotation);
  return reading;
}

void RequireStamp(const std_msgs::Header& header) {
  if (header.stamp.isZero()) throw ConfigError("header.stamp is 0, wanted the reading's time");
}

}  // namespace

OdometryFilterNode::OdometryFilterNode(const OdometryFilterNodeParams& params, ros::NodeHandle* nh)
    : params_(params),
      nh_(*nh),
      transforms_(nh,
                  [this](const TransformBuffer::News& news) {
                    for (const std::string& warning : news.warnings) Drop(kTransforms, warning);
                    for (const std::string& doubt : news.doubts)
                      warnings_.Tell(kTransforms, "doubtful", doubt);
                    if (!unplaced_.empty()) Advance();
                  }),
      filter_(params.config.filter),
      heading_(&filter_) {
  pose_ =
      nh->advertise<geometry_msgs::PoseWithCovarianceStamped>("robot_pose_ekf/odom_combined", 10);
  if (params.config.node.tf_broadcast)
    transform_ = nh->advertise<tf2_msgs::TFMessage>(kTransforms, 100);
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  inputs_.push_back(nh->subscribe(kOdometry, 100, &OdometryFilterNode::OnOdometry, this, hints));
  if (params.config.node.imu_used)
    inputs_.push_back(nh->subscribe(kInertia, 100, &OdometryFilterNode::OnInertia, this, hints));
  updater_.setHardwareID("odometry_filter");
  updater_.add("odometry", this, &OdometryFilterNode::Diagnose);
  // Also while simulated time stands still.
  timer_ = nh->createSteadyTimer(ros::WallDuration(1.0),
                                 [this](const ros::SteadyTimerEvent&) { updater_.force_update(); });
}

void OdometryFilterNode::OnOdometry(const nav_msgs::Odometry& msg) {
  odometry_came_ = hires::base::SteadyNow();
  try {
    RequireStamp(msg.header);
    RequireRotation(msg.pose.pose.orientation, "pose.pose.orientation");
    if (hires::sensing::BareFrame(msg.child_frame_id) != params_.base_frame) {
      throw ConfigError(
          fmt::format("child_frame_id is '{}', wanted '{}'; the names file says what "
                      "the robot calls its base",
                      msg.child_frame_id, params_.base_frame));
    }
  } catch (const ConfigError& error) {
    return Drop(kOdometry, error.what());
  }
  if ((msg.header.stamp - newest_odometry_).toSec() < -kJumpBack) {
    for (const Waiting& odometry : std::exchange(waiting_, {})) Filter(odometry);
    newest_odometry_ = msg.header.stamp;
  }
  newest_odometry_ = std::max(newest_odometry_, msg.header.stamp);
  waiting_.push_back({msg.header.stamp, FromMsg(msg)});
  Advance();
}

void OdometryFilterNode::OnInertia(const sensor_msgs::Imu& msg) {
  inertia_came_ = hires::base::SteadyNow();
  try {
    RequireStamp(msg.header);
    if (TellsOrientation(msg)) {
      RequireRotation(msg.orientation, "orientation");
    } else if (msg.angular_velocity_covariance[0] < 0.0) {
      throw ConfigError(
          "orientation_covariance and angular_velocity_covariance begin with -1: the unit tells "
          "neither, wanted one of them");
    }
  } catch (const ConfigError& error) {
    return Drop(kInertia, error.what());
  }
  unplaced_.push_back(msg);
  if (unplaced_.size() > kMostUnplaced) DropUnplaced();
  Advance();
}

void OdometryFilterNode::Advance() {
  UseInertia();
  while (!waiting_.empty() && !MustWait(waiting_.front())) {
    const Waiting odometry = waiting_.front();
    waiting_.pop_front();
    Filter(odometry);
    while (!unplaced_.empty() && unplaced_.front().header.stamp <= odometry.stamp) DropUnplaced();
  }
}

/// Readings of which tf says how their unit is mounted, which does not change: so the newest it
/// says will do. Those before one of them will not be used any more.
void OdometryFilterNode::UseInertia() {
  const TransformBuffer& tree = transforms_.tree();
  for (std::size_t i = 0; i < unplaced_.size();) {
    const std::string frame = hires::sensing::BareFrame(unplaced_[i].header.frame_id);
    const double newest = tree.NewestOf(params_.base_frame, frame).value_or(0.0);
    const hires::sensing::FramePose X_BI = tree.Find(params_.base_frame, frame, newest);
    if (!X_BI.is_found()) {
      ++i;
      continue;
    }
    for (; i > 0; --i) DropUnplaced();
    const sensor_msgs::Imu msg = unplaced_.front();
    unplaced_.pop_front();
    newest_inertia_ = msg.header.stamp;
    Note(kInertia, heading_.Take(ReadingOf(msg, X_BI.X_PC)));
  }
}

void OdometryFilterNode::DropUnplaced() {
  const std::string given = unplaced_.front().header.frame_id;
  unplaced_.pop_front();
  const std::string frame = hires::sensing::BareFrame(given);
  const double newest = transforms_.tree().NewestOf(params_.base_frame, frame).value_or(0.0);
  Drop(kInertia,
       fmt::format("header.frame_id is '{}', wanted a frame that tf connects with '{}': {}", given,
                   params_.base_frame,
                   transforms_.tree().WhyNot(params_.base_frame, frame, newest)));
}

bool OdometryFilterNode::MustWait(const Waiting& first) const {
  const auto& node = params_.config.node;
  return node.imu_used && newest_inertia_ < first.stamp &&
         (newest_odometry_ - first.stamp).toSec() <= node.imu_wait;
}

void OdometryFilterNode::Filter(const Waiting& odometry) {
  const auto outcome = filter_.OnOdometry(odometry.stamp.toSec(), odometry.reading);
  Note(kOdometry, outcome);
  if (outcome == FilterOutcome::kNotFinite || outcome == FilterOutcome::kLate) return;
  std_msgs::Header header;
  header.stamp = odometry.stamp;
  header.frame_id = params_.odometry_frame;
  pose_.publish(ToMsg(UncertainPose{filter_.X_FB(), filter_.Covariance()}, header));
  if (!transform_) return;
  tf2_msgs::TFMessage msg;
  msg.transforms.push_back(MakeTransform(params_.odometry_frame, params_.base_frame,
                                         hires::geometry::Lift(filter_.X_FB()), odometry.stamp));
  transform_.publish(msg);
}

void OdometryFilterNode::Note(const std::string& topic, FilterOutcome outcome) {
  const std::string name = hires::localisation::ToString(outcome);
  ++counts_[topic][name];
  if (outcome != FilterOutcome::kTaken)
    warnings_.Tell(topic, IsUsed(outcome) ? "used" : "dropped", name);
}

void OdometryFilterNode::Drop(const std::string& topic, const std::string& why) {
  ++counts_[topic]["dropped"];
  last_drop_ = topic + ": " + why;
  warnings_.Tell(topic, "dropped", why);
}

void OdometryFilterNode::Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const auto& config = params_.config;
  const double now = hires::base::SteadyNow();
  if (!filter_.has_estimate()) {
    status.summary(DiagnosticStatus::WARN, "waits for " + nh_.resolveName(kOdometry));
  } else if (now - odometry_came_ > config.filter.odometry_timeout) {
    status.summary(DiagnosticStatus::ERROR,
                   fmt::format("nothing came on {} for {:.1f} s", nh_.resolveName(kOdometry),
                               now - odometry_came_));
  } else if (!config.node.imu_used) {
    status.summary(DiagnosticStatus::OK, "wheels alone");
  } else if (now - inertia_came_ > config.filter.imu_timeout) {
    status.summary(DiagnosticStatus::WARN,
                   "wheels alone: nothing comes on " + nh_.resolveName(kInertia));
  } else if (counts_[kInertia]["taken"] == 0) {
    status.summary(DiagnosticStatus::WARN, "wheels alone: no inertial reading can be used");
  } else {
    status.summary(DiagnosticStatus::OK, "wheels and inertial unit");
  }
  for (const auto& [topic, outcomes] : counts_) {
    for (const auto& [outcome, count] : outcomes)
      status.add(fmt::format("{}, {}", topic, outcome), count);
  }
  const Eigen::Vector3d sd = filter_.Covariance().diagonal().cwiseMax(0.0).cwiseSqrt();
  status.add("standard deviation of x [m]", sd.x());
  status.add("standard deviation of y [m]", sd.y());
  status.add("standard deviation of yaw [rad]", sd.z());
  status.add("dropped last", last_drop_);
}

}  // namespace hires_ros
