#include "reports/experience/load_follower.h"

#include <fmt/format.h>

#include <cmath>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/robot/posture.h"
#include "hires/robot/tray.h"

namespace hires::reports {
namespace {

using geometry::Pose3;
using world::ObjectState;

constexpr double kShortestGap = 0.9 * knowledge::kExperiencePeriod;  // [s]

geometry::Aabb RequirePlate(const robot::Robot& robot) {
  if (const auto plate = robot::TrayPlateOf(robot)) return *plate;
  throw base::ConfigError(fmt::format(
      "robot '{}' has no tray, wanted one to look at what stands there; name its link in the "
      "profile (tray_link)",
      robot.model.name));
}

void RequireNumbers(const world::WorldState& world, const robot::RobotState& robot) {
  const auto fail = [](const std::string& what) {
    throw base::ConfigError(what + " is no number; wanted finite ones");
  };
  if (!robot.X_MB.IsFinite()) fail("the pose of the robot");
  for (const auto& [joint, position] : robot.joints) {
    if (!std::isfinite(position)) fail(fmt::format("the position of joint {}", joint));
  }
  for (const ObjectState& object : world.objects) {
    if (!object.X_MO.IsFinite()) fail(fmt::format("the pose of {}", object.name));
  }
}

std::string TopicOf(base::ParamReader* in, const std::string& key) {
  const std::string topic = in->GetString(key);
  if (topic.empty()) in->Fail(key, "is empty, wanted a topic");
  return topic;
}

}  // namespace

LoadFollower::LoadFollower(const Params& params, const robot::Robot& robot,
                           const imagination::RolloutParams& rollout)
    : params_{base::ToLower(params.object), params.after_fall},
      robot_(robot),
      plate_T_(RequirePlate(robot)),
      topple_tilt_(rollout.topple_tilt),
      monitor_(rollout) {}

std::optional<knowledge::ToppleEpisodePart> LoadFollower::Add(
    double time, const world::WorldState& world, const robot::RobotState& robot_state) {
  RequireNumbers(world, robot_state);
  const bool goes_on = time_ && time > *time_;
  if (goes_on && time < *time_ + kShortestGap) return std::nullopt;
  if (!goes_on || time > *time_ + knowledge::kExperienceGap) Drop();
  const std::size_t tray = *robot_.model.FindLink(robot_.profile.tray_link);
  const Pose3 X_MB = geometry::Lift(robot_state.X_MB);
  const Pose3 X_MT = X_MB * robot::ForwardKinematics(
                                robot_.model, robot::PostureOf(robot_, robot_state.joints))[tray];
  time_ = time;
  const ObjectState* object = load_.empty() ? Find(world, X_MT) : world.Find(load_);
  if (IsLost(time, object, X_MT)) {
    Drop();
    return std::nullopt;
  }
  load_ = object->name;
  return monitor_.Add({time, robot_state.X_MB, object->X_MO, X_MB.Inverse() * object->X_MO});
}

/// What has begun to stand on the tray, or null.
const ObjectState* LoadFollower::Find(const world::WorldState& world, const Pose3& X_MT) const {
  for (const ObjectState& object : world.objects) {
    const bool is_wanted = params_.object.empty() || base::ToLower(object.name) == params_.object;
    const bool stands = object.attached_to.empty() && IsOverTray(object, X_MT) && !IsDown(object);
    if (is_wanted && stands) return &object;
  }
  return nullptr;
}

bool LoadFollower::IsOverTray(const ObjectState& object, const Pose3& X_MT) const {
  return robot::IsOverPlate(plate_T_, X_MT.Inverse() * object.X_MO.translation);
}

bool LoadFollower::IsDown(const ObjectState& object) const {
  return geometry::TiltOf(object.X_MO.rotation) >= topple_tilt_;
}

bool LoadFollower::IsLost(double time, const ObjectState* object, const Pose3& X_MT) {
  if (!object || !object->attached_to.empty()) return true;
  if (!IsDown(*object)) {
    down_.reset();
    return !IsOverTray(*object, X_MT);
  }
  if (!down_) down_ = time;
  return time - *down_ > params_.after_fall + 0.5 * knowledge::kExperiencePeriod;
}

void LoadFollower::Drop() {
  load_.clear();
  down_.reset();
  monitor_.Begin();
}

ToppleMonitorConfig ReadToppleMonitorConfig(base::ParamReader in) {
  ToppleMonitorConfig config;
  config.world_topic = TopicOf(&in, "world_state");
  config.robot_topic = TopicOf(&in, "robot_state");
  config.follower.object = in.GetString("object");
  config.follower.after_fall = in.Get("after_fall", base::Between(0.0, 3600.0));
  in.RejectUnknownKeys();
  return config;
}

}  // namespace hires::reports
