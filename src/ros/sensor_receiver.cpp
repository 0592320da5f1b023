#include "hires/ros/sensor_receiver.h"

#include <fmt/format.h>

#include "hires/base/log.h"
#include "hires/base/process.h"
#include "hires/ros/conversions.h"
#include "hires/ros/robot_messages.h"
#include "hires/ros/robot_topics.h"

namespace hires_ros {
namespace {

namespace sensing = hires::sensing;

constexpr double kWarningPeriod = 1.0;  // [s] for each topic

}  // namespace

SensorReceiver::SensorReceiver(std::shared_ptr<const hires::robot::Robot> robot,
                               std::shared_ptr<const hires::perception::Surroundings> surroundings,
                               const hires::control::RobotNames& names,
                               const sensing::SensingParams& params)
    : names_(names),
      tree_(std::make_shared<TransformBuffer>()),
      state_(robot, {names.map_frame, names.odometry_frame, names.base_frame}, params.robot_state,
             names.map_to_world, tree_) {
  if (!surroundings) return;
  objects_ = std::make_unique<sensing::ObjectEstimator>(std::move(surroundings), std::move(robot),
                                                        params.memory, &state_);
}

void SensorReceiver::OnOdometry(const nav_msgs::Odometry& msg) {
  Note(names_.odometry, state_.OnOdometry(msg.header.stamp.toSec(), msg.header.frame_id,
                                          msg.child_frame_id, FromMsg(msg)));
}

void SensorReceiver::OnJoints(const sensor_msgs::JointState& msg) {
  if (msg.name.size() != msg.position.size()) {
    ++num_bad_;
    return Warn(names_.joint_states,
                fmt::format("{} names and {} positions, wanted one position for each name",
                            msg.name.size(), msg.position.size()));
  }
  Note(names_.joint_states, state_.OnJoints(msg.header.stamp.toSec(), FromMsg(msg)));
}

void SensorReceiver::OnTransforms(const tf2_msgs::TFMessage& msg, bool are_static) {
  const TransformBuffer::News news = tree_->Take(msg, are_static);
  num_bad_ += static_cast<int>(news.warnings.size());
  for (const std::string& warning : news.warnings) Warn(kTransforms, warning);
  for (const double stamp : news.stamps) Note(kTransforms, state_.OnTransforms(stamp));
}

void SensorReceiver::OnDetections(const hires::Detections& msg) {
  if (!objects_) return;
  sensing::Look look{msg.header.stamp.toSec(), msg.header.frame_id, {}};
  for (const auto& detection : msg.detections) look.detections.push_back(FromMsg(detection));
  for (const std::string& why : objects_->OnLook(std::move(look))) {
    ++num_bad_;
    Warn(kDetections, why);
  }
}

void SensorReceiver::OnKnownObjects(const hires::WorldState& msg) {
  if (sensing::BareFrame(msg.header.frame_id) == names_.map_frame) {
    stated_ = std::make_unique<hires::WorldState>(msg);
    return;
  }
  ++num_bad_;
  Warn(kKnownObjects,
       fmt::format("frame_id is '{}', wanted '{}'", msg.header.frame_id, names_.map_frame));
}

sensing::LookNews SensorReceiver::Update(const sensing::RobotEstimate& now) {
  if (!objects_) return {};
  if (const auto stated = std::move(stated_)) {
    const auto then = state_.At(stated->header.stamp.toSec());
    for (const std::string& why : objects_->OnStated(FromMsg(*stated), then.value_or(now))) {
      Warn(kKnownObjects, why);
    }
  }
  sensing::LookNews news = objects_->Update(now);
  for (const std::string& why : news.warnings) Warn(kDetections, why);
  return news;
}

std::string SensorReceiver::NameOf(sensing::Missing missing) const {
  switch (missing) {
    case sensing::Missing::kNothing:
      return "";
    case sensing::Missing::kOdometry:
      return names_.odometry;
    case sensing::Missing::kOdometryFrame:
      return names_.odometry_frame + " -> " + names_.base_frame;
    case sensing::Missing::kJointStates:
      return names_.joint_states;
    case sensing::Missing::kLocalisation:
      return names_.map_frame + " -> " + names_.odometry_frame;
  }
  return "";
}

void SensorReceiver::Note(const std::string& topic, const sensing::Receipt& receipt) {
  if (!receipt.is_bad()) return;
  ++num_bad_;
  Warn(topic, sensing::ToString(receipt));
}

void SensorReceiver::Warn(const std::string& topic, const std::string& text) {
  const auto warned = warned_.find(topic);
  if (warned != warned_.end() && hires::base::SteadyNow() - warned->second < kWarningPeriod) return;
  warned_[topic] = hires::base::SteadyNow();
  hires::base::Log(hires::base::LogLevel::kWarn,
                   fmt::format("topic={} dropped why={}", topic, text));
}

}  // namespace hires_ros
