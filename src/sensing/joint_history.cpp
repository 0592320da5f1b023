#include "hires/sensing/joint_history.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "hires/geometry/angles.h"
#include "hires/robot/posture.h"

namespace hires::sensing {
namespace {

/// Looks names up in a sorted map, in ascending order: each entry is passed once.
template <typename Map>
class InOrder {
 public:
  explicit InOrder(Map& map) : next_(map.begin()), end_(map.end()) {}
  /// What the name has, or nullptr.
  auto Find(const std::string& name) -> decltype(&std::declval<Map&>().begin()->second) {
    while (next_ != end_ && next_->first < name) ++next_;
    return next_ != end_ && next_->first == name ? &next_->second : nullptr;
  }
  auto place() const { return next_; }  ///< where the name would be put

 private:
  decltype(std::declval<Map&>().begin()) next_, end_;
};

/// Sets the positions (or velocities) of all joints that `newer` names.
void Overwrite(const std::map<std::string, double>& newer, std::map<std::string, double>* values) {
  InOrder known(*values);
  for (const auto& [name, value] : newer) {
    if (double* old = known.Find(name)) {
      *old = value;
    } else {
      values->emplace_hint(known.place(), name, value);
    }
  }
}

/// A joint's last word before, or first word after some time.
struct Word {
  double stamp;
  double position;
  std::optional<double> velocity;
};

/// Words by joint, sorted by name; the names are those of the readings.
using Words = std::vector<std::pair<const std::string*, Word>>;

bool NameBefore(const Words::value_type& a, const Words::value_type& b) {
  return *a.first < *b.first;
}

/// Adds what joints say of which there is no word yet.
void AddWords(double stamp, const robot::JointReading& reading, Words* words) {
  Words said;
  said.reserve(reading.positions.size());
  InOrder velocities(reading.velocities);
  for (const auto& [name, position] : reading.positions) {
    const double* velocity = velocities.Find(name);
    said.push_back(
        {&name, Word{stamp, position, velocity ? std::make_optional(*velocity) : std::nullopt}});
  }
  if (words->empty()) return words->swap(said);
  Words all;  // of two with the same name the first is kept
  all.reserve(words->size() + said.size());
  std::set_union(words->begin(), words->end(), said.begin(), said.end(), std::back_inserter(all),
                 NameBefore);
  words->swap(all);
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

/// @pre names come in ascending order
void Take(const std::string& name, const Word& word, robot::JointReading* reading) {
  reading->positions.emplace_hint(reading->positions.end(), name, word.position);
  if (word.velocity) {
    reading->velocities.emplace_hint(reading->velocities.end(), name, *word.velocity);
  }
}

double Clamped(const robot::Joint& joint, double position) {
  if (!joint.limits || joint.type == robot::JointType::kContinuous) return position;
  return std::clamp(position, joint.limits->lower, joint.limits->upper);
}

}  // namespace

JointHistory::JointHistory(std::shared_ptr<const robot::Robot> robot) : robot_(std::move(robot)) {
  for (const robot::Link& link : robot_->model.links) {
    if (link.joint) joints_.emplace(link.joint->name, &*link.joint);
  }
}

/// A robot without arms is not asked which joints it has.
bool JointHistory::IsOurs(const robot::Joint* joint) const {
  return joint == nullptr ? !robot_->profile.upper_body : joint->mimics.empty();
}

bool JointHistory::Insert(double stamp, const robot::JointReading& reading) {
  robot::JointReading ours;
  InOrder joints(joints_);
  for (const auto& [name, position] : reading.positions) {
    const auto* joint = joints.Find(name);
    if (!IsOurs(joint ? *joint : nullptr)) continue;
    ours.positions.emplace_hint(ours.positions.end(), name,
                                joint ? Clamped(**joint, position) : position);
  }
  InOrder moving(joints_);
  for (const auto& [name, velocity] : reading.velocities) {
    const auto* joint = moving.Find(name);
    if (!IsOurs(joint ? *joint : nullptr)) continue;
    ours.velocities.emplace_hint(ours.velocities.end(), name, velocity);
  }
  for (const auto& [name, unused] : ours.positions) names_.insert(name);
  robot::JointReading* same = history_.Find(stamp);
  if (same == nullptr) return history_.Insert(stamp, std::move(ours));
  const std::size_t before = same->positions.size();
  same->positions.merge(ours.positions);
  same->velocities.merge(ours.velocities);
  return same->positions.size() > before;
}

void JointHistory::KeepBetween(double from, double to) {
  for (const auto& entry : history_) {
    if (entry.stamp >= from) break;
    Overwrite(entry.value.positions, &older_.positions);
    Overwrite(entry.value.velocities, &older_.velocities);
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

robot::JointReading JointHistory::At(double time, double max_gap) const {
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
  robot::JointReading reading;
  InOrder joints(joints_);
  const auto between = [&](const std::string& name, const Word& last, const Word& next) {
    if (last.stamp >= time || next.stamp - last.stamp > max_gap) return last;
    const auto* joint = joints.Find(name);
    return Between(joint ? *joint : nullptr, last, next, time);
  };
  auto next = after.begin();
  for (const auto& [name, word] : before) {
    for (; next != after.end() && *next->first < *name; ++next) {
      Take(*next->first, next->second, &reading);
    }
    const bool is_both = next != after.end() && *next->first == *name;
    Take(*name, is_both ? between(*name, word, next->second) : word, &reading);
    if (is_both) ++next;
  }
  for (; next != after.end(); ++next) Take(*next->first, next->second, &reading);
  return reading;
}

robot::JointPositions JointHistory::PostureOf(const robot::JointPositions& measured) const {
  robot::JointPositions known;
  InOrder joints(joints_);
  for (const auto& [name, position] : measured) {
    const auto* joint = joints.Find(name);
    if (joint == nullptr || (*joint)->type == robot::JointType::kFixed) continue;
    known.emplace_hint(known.end(), name, position);
  }
  return robot::PostureOf(*robot_, known);
}

}  // namespace hires::sensing
