#include "hires/ros/sensing/sensor_receiver.h"

#include <fmt/format.h>

#include <cmath>

#include "hires/ros/names/robot_topics.h"
#include "hires/ros/perception/detection_messages.h"
#include "hires/ros/robot/robot_messages.h"
#include "hires/ros/robot/scan_messages.h"
#include "hires/ros/world/world_messages.h"

namespace hires_ros {
namespace {

namespace sensing = hires::sensing;

constexpr double kFramePatience = 0.2;  // [s] that the transform of what is stated may be late

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
  for (const std::string& doubt : news.doubts) warnings_.Tell(kTransforms, "doubtful", doubt);
  for (const double stamp : news.stamps) Note(kTransforms, state_.OnTransforms(stamp));
}

void SensorReceiver::OnDetections(const hires::Detections& msg) {
  if (!objects_) return;
  auto seen = FromMsg(msg);
  if (!seen) return;
  sensing::Look look{msg.header.stamp.toSec(), msg.header.frame_id, std::move(seen->detections),
                     std::move(seen->table)};
  for (const std::string& why : objects_->OnLook(std::move(look))) {
    ++num_bad_;
    Warn(kDetections, why);
  }
}

void SensorReceiver::OnTrayScan(const sensor_msgs::LaserScan& msg) {
  if (!objects_) return;
  const auto problems =
      objects_->OnTrayScan(msg.header.stamp.toSec(), msg.header.frame_id, ReadingOf(msg));
  for (const std::string& why : problems) {
    ++num_bad_;
    Warn(names_.sensors.tray_scan, why);
  }
}

std::map<std::string, double> SensorReceiver::TemperaturesOf(const hires::ObjectTemperatures& msg) {
  constexpr double kColdest = -273.15;  // [degrees Celsius]
  std::map<std::string, double> degrees;
  for (const hires::ObjectTemperature& object : msg.objects) {
    if (!std::isfinite(object.temperature) || object.temperature < kColdest ||
        object.object.empty()) {
      ++num_bad_;
      Warn(kObjectTemperatures,
           fmt::format("object '{}': temperature is {}, wanted a name, and degrees Celsius from "
                       "{} on; it is left out",
                       object.object, object.temperature, kColdest));
    } else if (object.mixed_with.empty()) {
      degrees[object.object] = object.temperature;
    }
  }
  return degrees;
}

void SensorReceiver::OnKnownObjects(const hires::WorldState& msg) {
  if (!msg.header.frame_id.empty()) {
    stated_ = std::make_unique<hires::WorldState>(msg);
    return;
  }
  ++num_bad_;
  Warn(kKnownObjects,
       fmt::format("frame_id is empty, wanted '{}' or a frame that tf connects with it",
                   names_.map_frame));
}

sensing::LookNews SensorReceiver::Update(const sensing::RobotEstimate& now) {
  if (!objects_) return {};
  if (stated_) TakeStated(now);
  sensing::LookNews news = objects_->Update(now);
  for (const std::string& why : news.warnings) Warn(kDetections, why);
  return news;
}

/// Poses in another frame than the map's become such in the world, by where the robot was then.
void SensorReceiver::TakeStated(const sensing::RobotEstimate& now) {
  const auto then = state_.At(stated_->header.stamp.toSec()).value_or(now);
  const std::string frame = sensing::BareFrame(stated_->header.frame_id);
  hires::world::WorldState world = FromMsg(*stated_);
  if (frame != names_.map_frame) {
    const sensing::FramePose X_BF = state_.InBase(frame, then);
    const bool may_come = X_BF.status == sensing::FrameStatus::kNotThen;
    if (may_come && now.time < stated_->header.stamp.toSec() + kFramePatience) return;
    if (!X_BF.is_found()) {
      stated_.reset();
      ++num_bad_;
      return Warn(kKnownObjects,
                  fmt::format("wanted poses in '{}', or in a frame that leads there: {}",
                              names_.map_frame, tree_->WhyNot(names_.map_frame, frame, then.time)));
    }
    const auto X_WF = hires::geometry::Lift(then.X_WB) * X_BF.X_PC;
    for (auto& object : world.objects) object.X_MO = X_WF * object.X_MO;
  }
  stated_.reset();
  for (const std::string& why : objects_->OnStated(world, then)) Warn(kKnownObjects, why);
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
  if (receipt.is_bad()) Refuse(topic, sensing::ToString(receipt));
}

void SensorReceiver::Refuse(const std::string& topic, const std::string& why) {
  ++num_bad_;
  Warn(topic, why);
}

void SensorReceiver::Warn(const std::string& topic, const std::string& text) {
  warnings_.Tell(topic, "dropped", text);
}

}  // namespace hires_ros
