#include "hires/sensing/joint_history.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "hires/geometry/angles.h"
#include "hires/robot/posture.h"

namespace hires::sensing {
namespace {

/// A joint's last word before, or first word after some time.
struct Word {
  double stamp;
  double position;
  std::optional<double> velocity;
};
using Words = std::map<std::string, Word>;

std::optional<double> VelocityIn(const JointReading& reading, const std::string& name) {
  const auto velocity = reading.velocities.find(name);
  if (velocity == reading.velocities.end()) return std::nullopt;
  return velocity->second;
}

void AddWords(double stamp, const JointReading& reading, Words* words) {
  for (const auto& [name, position] : reading.positions) {
    words->insert({name, Word{stamp, position, VelocityIn(reading, name)}});
  }
}

/// A joint that turns without end takes the shorter way.
Word Between(const robot::Joint* joint, const Word& from, const Word& to, double time) {
  const bool is_endless = joint != nullptr && joint->type == robot::JointType::kContinuous;
  const double share = (time - from.stamp) / (to.stamp - from.stamp);
  const double way = to.position - from.position;
  Word between{time, from.position + share * (is_endless ? geometry::WrapToPi(way) : way), {}};
  if (from.velocity && to.velocity) {
    between.velocity = *from.velocity + share * (*to.velocity - *from.velocity);
  }
  return between;
}

void Take(const std::string& name, const Word& word, JointReading* reading) {
  reading->positions[name] = word.position;
  reading->velocities.erase(name);
  if (word.velocity) reading->velocities[name] = *word.velocity;
}

}  // namespace

JointHistory::JointHistory(std::shared_ptr<const robot::Robot> robot) : robot_(std::move(robot)) {}

/// A robot without arms is not asked which joints it has.
bool JointHistory::IsOurs(const std::string& name) const {
  const robot::Joint* joint = robot::FindJoint(robot_->model, name);
  return joint == nullptr ? !robot_->profile.upper_body : joint->mimics.empty();
}

double JointHistory::Clamped(const std::string& name, double position) const {
  const robot::Joint* joint = robot::FindJoint(robot_->model, name);
  if (joint == nullptr || !joint->limits) return position;
  if (joint->type == robot::JointType::kContinuous) return position;
  return std::clamp(position, joint->limits->lower, joint->limits->upper);
}

bool JointHistory::Insert(double stamp, const JointReading& reading) {
  JointReading ours;
  for (const auto& [name, position] : reading.positions) {
    if (IsOurs(name)) ours.positions[name] = Clamped(name, position);
  }
  for (const auto& [name, velocity] : reading.velocities) {
    if (IsOurs(name)) ours.velocities[name] = velocity;
  }
  for (const auto& [name, unused] : ours.positions) names_.insert(name);
  JointReading* same = history_.Find(stamp);
  if (same == nullptr) return history_.Insert(stamp, std::move(ours));
  const std::size_t before = same->positions.size();
  same->positions.merge(ours.positions);
  same->velocities.merge(ours.velocities);
  return same->positions.size() > before;
}

void JointHistory::KeepBetween(double from, double to) {
  for (const auto& entry : history_) {
    if (entry.stamp >= from) break;
    for (const auto& [name, position] : entry.value.positions) older_.positions[name] = position;
    for (const auto& [name, speed] : entry.value.velocities) older_.velocities[name] = speed;
  }
  history_.KeepBetween(from, to);
}

void JointHistory::Clear() {
  history_.Clear();
  older_ = {};
  names_.clear();
}

std::optional<double> JointHistory::NextAfter(double time) const {
  const auto* next = history_.After(time);
  if (next == nullptr) return std::nullopt;
  return next->stamp;
}

double JointHistory::DistanceTo(double time) const {
  double distance = std::numeric_limits<double>::infinity();
  if (const auto* before = history_.Before(time)) distance = time - before->stamp;
  if (const auto* after = history_.After(time)) distance = std::min(distance, after->stamp - time);
  return distance;
}

JointReading JointHistory::At(double time, double max_gap) const {
  Words before, after;
  const auto place = std::partition_point(history_.begin(), history_.end(),
                                          [&](const auto& entry) { return entry.stamp <= time; });
  for (auto entry = place; entry != history_.begin() && before.size() < names_.size();) {
    --entry;
    AddWords(entry->stamp, entry->value, &before);
  }
  AddWords(-std::numeric_limits<double>::infinity(), older_, &before);
  for (auto entry = place; entry != history_.end() && after.size() < names_.size(); ++entry) {
    AddWords(entry->stamp, entry->value, &after);
  }
  JointReading reading;
  for (const auto& [name, word] : after) Take(name, word, &reading);
  for (const auto& [name, word] : before) {
    const auto next = after.find(name);
    const bool is_between =
        word.stamp < time && next != after.end() && next->second.stamp - word.stamp <= max_gap;
    const robot::Joint* joint = robot::FindJoint(robot_->model, name);
    Take(name, is_between ? Between(joint, word, next->second, time) : word, &reading);
  }
  return reading;
}

robot::JointPositions JointHistory::PostureOf(const robot::JointPositions& measured) const {
  robot::JointPositions known;
  for (const auto& [name, position] : measured) {
    const robot::Joint* joint = robot::FindJoint(robot_->model, name);
    if (joint != nullptr && joint->type != robot::JointType::kFixed) known[name] = position;
  }
  return robot::PostureOf(*robot_, known);
}

}  // namespace hires::sensing
