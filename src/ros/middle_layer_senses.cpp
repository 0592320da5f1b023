#include "hires/ros/middle_layer_senses.h"

#include <algorithm>
#include <utility>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/text.h"
#include "hires/ros/robot_topics.h"
#include "hires/skills/manipulation_context.h"

namespace hires_ros {
namespace {

using hires::geometry::Pose2;
using hires::geometry::Pose3;
using hires::perception::Detection;
using hires::robot::Observation;

constexpr double kHistory = 2.0;  // [s] of odometry: older sightings and scans are not waited for

Pose2 LaserPose(const hires::robot::Robot& robot) {
  if (robot.profile.laser_link.empty()) return {};
  const auto link = robot.model.FindLink(robot.profile.laser_link);
  const auto base = robot.model.FindLink(robot.profile.base_link);
  HIRES_CHECK(link && base, "the profile's links are the model's");
  const auto X_RL = hires::robot::ForwardKinematics(robot.model, robot.profile.joints);
  return hires::geometry::Flatten(X_RL[*base].Inverse() * X_RL[*link]);
}

/// A real robot tells of more joints than skills may set: those that follow others (a PR2's finger
/// tips), and those that its model does not have. A robot without arms is not asked for any.
bool IsOurs(const hires::robot::Robot& robot, const std::string& name) {
  const hires::robot::Joint* joint = hires::robot::FindJoint(robot.model, name);
  return joint == nullptr ? !robot.profile.upper_body : joint->mimics.empty();
}

/// A link of the robot in the map; no name is the map itself.
Pose3 LinkPose(const hires::robot::Robot& robot, const hires::sensing::BodyReading& body,
               const std::string& link) {
  if (link.empty()) return {};
  const auto index = robot.model.FindLink(link);
  const auto base = robot.model.FindLink(robot.profile.base_link);
  if (!index || !base) {
    throw hires::base::ConfigError(std::string(kKnownObjects) + ": " +
                                   hires::base::UnknownName("link", link, robot.model.LinkNames()));
  }
  const auto X_RL = hires::robot::ForwardKinematics(robot.model, body.joints);
  return hires::geometry::Lift(body.X_MB) * X_RL[*base].Inverse() * X_RL[*index];
}

}  // namespace

Senses::Senses(std::shared_ptr<const hires::robot::Robot> robot,
               std::shared_ptr<const hires::perception::Surroundings> surroundings,
               const hires::sensing::ScanObstacles& obstacles, const RobotNames& names,
               double stale_after)
    : robot_(std::move(robot)),
      find_obstacles_(obstacles),
      names_(names),
      stale_after_(stale_after),
      X_BL_(LaserPose(*robot_)) {
  if (surroundings) memory_.emplace(std::move(surroundings), robot_);
}

void Senses::OnOdometry(double stamp, const OdometryReading& reading) {
  if (!odometry_.empty() && stamp <= odometry_.back().stamp) return;
  odometry_.push_back({stamp, reading});
  while (odometry_.front().stamp < stamp - kHistory) odometry_.pop_front();
}

/// amcl dates its word ahead, by the time that it may be used; it is not newer for that than what
/// else is known when it comes.
void Senses::OnLocalisation(double stamp, const Pose2& X_MO) {
  const double known = odometry_.empty() ? stamp : std::min(stamp, odometry_.back().stamp);
  X_MO_ = {known, X_MO};
}

void Senses::OnJoints(double stamp, JointReading reading) {
  if (!joints_.empty() && stamp < joints_.back().stamp) return;
  // Several nodes may tell about some joints each.
  JointReading all = joints_.empty() ? JointReading() : joints_.back().value;
  for (auto& [name, position] : reading.positions) {
    if (IsOurs(*robot_, name)) all.positions[name] = position;
  }
  for (auto& [name, velocity] : reading.velocities) {
    if (IsOurs(*robot_, name)) all.velocities[name] = velocity;
  }
  joints_.push_back({stamp, std::move(all)});
  while (joints_.front().stamp < stamp - kHistory) joints_.pop_front();
}

void Senses::OnScan(double stamp, hires::sensing::ScanReading reading) {
  scan_ = {stamp, std::move(reading)};
}

void Senses::OnKnownObjects(const hires::world::WorldState& state) { hearsay_ = state; }

void Senses::OnDetections(double stamp, std::vector<Detection> detections) {
  if (!looks_.empty() && stamp <= looks_.back().stamp) return;
  looks_.push_back({stamp, std::move(detections)});
  while (looks_.front().stamp < stamp - kHistory) looks_.pop_front();
}

std::optional<double> Senses::CompleteUntil() const {
  if (!Missing().empty()) return std::nullopt;
  return std::min(odometry_.back().stamp, joints_.back().stamp);
}

std::string Senses::Missing() const {
  if (odometry_.empty()) return names_.odometry;
  if (joints_.empty()) return names_.joint_states;
  const double complete = std::min(odometry_.back().stamp, joints_.back().stamp);
  if (!X_MO_ || X_MO_->stamp + stale_after_ < complete) {
    return names_.map_frame + " -> " + names_.odometry_frame;
  }
  return "";
}

/// The newest that is not newer than `stamp`, else the oldest.
template <typename T>
const T& Senses::At(double stamp, const std::deque<Stamped<T>>& history) {
  for (auto entry = history.rbegin(); entry != history.rend(); ++entry) {
    if (entry->stamp <= stamp) return entry->value;
  }
  return history.front().value;
}

Pose2 Senses::BaseAt(double stamp) const {
  return names_.map_to_world.ToWorld(X_MO_->value * At(stamp, odometry_).X_OB);
}

hires::sensing::BodyReading Senses::BodyAt(double stamp) const {
  return {stamp, BaseAt(stamp), hires::skills::PostureOf(*robot_, At(stamp, joints_).positions)};
}

Observation Senses::Look(double stamp) {
  HIRES_CHECK(CompleteUntil() && stamp <= *CompleteUntil(), "the senses are not that far");
  FindObstacles();
  Observation seen;
  seen.time = stamp;
  seen.X_MB = BaseAt(stamp);
  seen.V_B = At(stamp, odometry_).V_B;
  seen.obstacles_M = obstacles_M_;
  const JointReading& joints = At(stamp, joints_);
  seen.joints = joints.positions;
  seen.joint_velocities = joints.velocities;
  if (memory_) LookAtObjects(stamp, &seen);
  return seen;
}

void Senses::FindObstacles() {
  if (!scan_ || scan_->stamp > odometry_.back().stamp) return;
  obstacles_M_ = find_obstacles_.Find(scan_->value, BaseAt(scan_->stamp), X_BL_);
  scan_.reset();
}

void Senses::LookAtObjects(double stamp, Observation* seen) {
  const hires::sensing::BodyReading body = BodyAt(stamp);
  try {
    Hear(body);
    while (!looks_.empty() && looks_.front().stamp <= stamp) {
      const auto look = std::move(looks_.front());
      looks_.pop_front();
      memory_->Look(BodyAt(look.stamp), look.value);
    }
  } catch (const hires::base::ConfigError& error) {  // one bad word is not the end of seeing
    hires::base::Log(hires::base::LogLevel::kWarn, error.what());
  }
  memory_->Feel(body);
  seen->objects = memory_->Known(body);
}

/// What others say; what they do not say any more is believed no longer.
void Senses::Hear(const hires::sensing::BodyReading& body) {
  if (!hearsay_) return;
  const hires::world::WorldState said = *std::exchange(hearsay_, std::nullopt);
  for (auto name = believed_.begin(); name != believed_.end();) {
    if (said.Find(*name) == nullptr) memory_->Disbelieve(*name);
    name = said.Find(*name) == nullptr ? believed_.erase(name) : std::next(name);
  }
  for (const hires::world::ObjectState& object : said.objects) {
    const Pose3 X_ML = LinkPose(*robot_, body, object.attached_to);
    memory_->Believe(object.name, object.model, object.attached_to, X_ML.Inverse() * object.X_MO);
    believed_.insert(hires::base::ToLower(object.name));
  }
}

}  // namespace hires_ros
