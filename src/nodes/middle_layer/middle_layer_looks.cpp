#include <fmt/format.h>
#include <ros/ros.h>

#include "hires/base/log.h"
#include "hires/control/tray_load.h"
#include "hires/ros/conversions.h"
#include "hires/ros/robot_messages.h"
#include "hires/ros/robot_topics.h"
#include "nodes/middle_layer/middle_layer_node.h"

// What comes from the robot: the other half of middle_layer_node.cpp.

namespace hires_ros {
namespace {

using hires::base::LogLevel;

constexpr double kWeighing = 0.5;    // [s] between two looks at the load
constexpr double kSameStamp = 1e-9;  // [s]

}  // namespace

void MiddleLayerNode::Subscribe(ros::NodeHandle* nh) {
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  const auto add = [&](ros::Subscriber subscriber) { subscribers_.push_back(subscriber); };
  add(nh->subscribe(params_.names.odometry, 100, &MiddleLayerNode::OnOdometry, this, hints));
  add(nh->subscribe<sensor_msgs::JointState>(
      params_.names.joint_states, 100,
      boost::function<void(const sensor_msgs::JointStateConstPtr&)>(
          [this](const sensor_msgs::JointStateConstPtr& msg) {
            sensors_.OnJoints(*msg);
            Note(params_.names.joint_states, msg->header.stamp.toSec());
          }),
      ros::VoidConstPtr(), hints));
  const auto on_transforms = [this](bool are_static) {
    return boost::function<void(const tf2_msgs::TFMessage&)>(
        [this, are_static](const tf2_msgs::TFMessage& msg) { OnTransforms(msg, are_static); });
  };
  add(nh->subscribe<tf2_msgs::TFMessage>(kTransforms, 100, on_transforms(false),
                                         ros::VoidConstPtr(), hints));
  add(nh->subscribe<tf2_msgs::TFMessage>(kStaticTransforms, 100, on_transforms(true)));
  add(nh->subscribe(params_.names.base_scan, 10, &MiddleLayerNode::OnScan, this, hints));
  add(nh->subscribe(kDetections, 10, &MiddleLayerNode::OnDetections, this, hints));
  add(nh->subscribe(kKnownObjects, 10, &SensorReceiver::OnKnownObjects, &sensors_, hints));
  if (params_.lockstep) {
    add(nh->subscribe(kLockstepTick, 10, &MiddleLayerNode::OnTick, this, hints));
  }
  if (params_.guard.is_there && !params_.dry_run) {
    add(nh->subscribe(kGuardState, 10, &BaseLeave::OnState, &leave_, hints));
  }
  if (!params_.names.motors_halted.empty()) {
    add(nh->subscribe<std_msgs::Bool>(
        params_.names.motors_halted, 10,
        boost::function<void(const std_msgs::BoolConstPtr&)>(
            [this](const std_msgs::BoolConstPtr& msg) { OnMotorsHalted(msg->data != 0); }),
        ros::VoidConstPtr(), hints));
  }
}

void MiddleLayerNode::OnOdometry(const nav_msgs::Odometry& msg) {
  sensors_.OnOdometry(msg);
  if (restarts_ != sensors_.state().num_restarts()) {  // the robot's clock began again
    restarts_ = sensors_.state().num_restarts();
    arrived_.clear();
    looked_ = -1.0;
  }
  Note(params_.names.odometry, msg.header.stamp.toSec());
}

/// A tick waits for the localisation of its stamp, whatever else is told of the frames.
void MiddleLayerNode::OnTransforms(const tf2_msgs::TFMessage& msg, bool are_static) {
  sensors_.OnTransforms(msg, are_static);
  if (const auto localised = sensors_.state().LocalisedUntil()) Note(kTransforms, *localised);
}

/// Whoever pulls the plug, or presses the button, means arms as well.
void MiddleLayerNode::OnMotorsHalted(bool are_halted) {
  if (are_halted && !are_motors_halted_) {
    hires::base::Log(LogLevel::kWarn, "motors=halted everything that runs ends");
    runner_.FailAll(hires::base::FailureCode::kMotorsHalted);
  }
  are_motors_halted_ = are_halted;
}

void MiddleLayerNode::OnGuardStopped(const hires::base::Failure& failure) {
  hires::base::Log(LogLevel::kWarn, fmt::format("request={} stopped by the guard: {}", leave_.id(),
                                                ToString(failure)));
  runner_.FailAll(failure);
}

void MiddleLayerNode::OnScan(const sensor_msgs::LaserScan& msg) {
  const double stamp = msg.header.stamp.toSec();
  const auto receipt = observations_.OnScan(
      stamp, msg.header.frame_id, {msg.angle_min, msg.angle_increment, msg.range_min, msg.ranges});
  if (receipt.is_bad()) {
    sensors_.Warn(params_.names.base_scan, hires::sensing::ToString(receipt));
  }
  Note(params_.names.base_scan, stamp);
}

void MiddleLayerNode::OnDetections(const hires::Detections& msg) {
  sensors_.OnDetections(msg);
  Note(kDetections, msg.header.stamp.toSec());
}

void MiddleLayerNode::OnTick(const hires::LockstepTick& msg) {
  awaited_ = msg.awaited;
  // A tick is repeated where the answer is late, or went before the robot listened.
  if (tick_ && tick_->header.stamp == msg.header.stamp) return;
  if (acked_ && acked_->header.stamp == msg.header.stamp) {
    ack_.publish(*acked_);
    return;
  }
  tick_ = msg;
  is_tick_looked_at_ = false;
  LookAtTick();
}

void MiddleLayerNode::Note(const std::string& topic, double stamp) {
  double& newest = arrived_[topic];
  newest = std::max(newest, stamp);
  if (params_.lockstep) {
    LookAtTick();
  } else if (topic == params_.names.odometry || topic == params_.names.joint_states) {
    LookWhereFree();
  }
}

void MiddleLayerNode::LookWhereFree() {
  const auto complete = sensors_.state().CompleteUntil();
  if (!complete || *complete <= looked_) return;
  looked_ = *complete;
  LookAt(looked_, looked_);
}

/// @param time   [s] that skills take for now.
/// @param stamp  [s] up to which the senses are complete.
void MiddleLayerNode::LookAt(double time, double stamp) {
  const auto now = sensors_.state().At(stamp);
  if (!now) return runner_.CheckFreshness(time);
  last_look_ = Steady::now();
  const hires::robot::Observation seen = ObservationOf(*now);
  override_.See(time, seen.V_B);
  if (params_.guard.is_there) WeighLoad(time, seen);
  runner_.Look(time, seen);
}

hires::robot::Observation MiddleLayerNode::ObservationOf(const hires::sensing::RobotEstimate& now) {
  hires::robot::Observation seen = observations_.Observe(now);
  const hires::sensing::Receipt& scan = observations_.scan_receipt();
  if (scan.is_bad()) sensors_.Warn(params_.names.base_scan, hires::sensing::ToString(scan));
  sensors_.Update(now);
  if (sensors_.objects()) seen.objects = sensors_.objects()->memory().Known(now.Body());
  return seen;
}

void MiddleLayerNode::WeighLoad(double time, const hires::robot::Observation& seen) {
  if (time >= weighed_ && time < weighed_ + kWeighing) return;
  weighed_ = time;
  const auto braking =
      hires::control::BrakingFor(setup_.scene->robot, setup_.scene->world, seen,
                                 setup_.scene->surroundings != nullptr, params_.guard.braking);
  braking_ = braking.value_or(hires::navigation::BrakingLimits{0.0, 0.0});
  leave_.SetBraking(braking_.max_deceleration, braking_.max_jerk);
  const hires::navigation::BrakingParams& params = params_.guard.braking;
  runner_.SetBraking({braking.value_or(params.unknown_load), params});
}

bool MiddleLayerNode::IsTickComplete() const {
  const double stamp = tick_->header.stamp.toSec();
  const auto is_there = [&](const std::string& topic) {
    const auto arrived = arrived_.find(topic);
    return arrived != arrived_.end() && arrived->second >= stamp - kSameStamp;
  };
  for (const std::string& topic : tick_->sensors) {
    if (!is_there(topic)) return false;
  }
  return true;
}

void MiddleLayerNode::LookAtTick() {
  if (!tick_ || is_tick_looked_at_ || !IsTickComplete()) return;
  is_tick_looked_at_ = true;
  const double stamp = tick_->header.stamp.toSec();
  const auto complete = sensors_.state().CompleteUntil();
  if (complete && *complete >= stamp - kSameStamp) {
    looked_ = stamp;
    LookAt(stamp, std::min(stamp, *complete));
  } else {
    runner_.CheckFreshness(stamp);
  }
  AnswerTick();
}

void MiddleLayerNode::AnswerTick() {
  if (!tick_ || !is_tick_looked_at_ || runner_.is_thinking()) return;
  hires::LockstepAck ack;
  ack.header.stamp = tick_->header.stamp;
  ack.num_commands = commands_since_ack_;
  commands_since_ack_ = 0;
  tick_.reset();
  acked_ = ack;
  ack_.publish(ack);
}

void MiddleLayerNode::OnWake() {
  runner_.Collect();
  PublishFeedback();
  AnswerTick();
}

}  // namespace hires_ros
