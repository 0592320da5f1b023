#include "hires/ros/world_tracker_senses.h"

#include <algorithm>
#include <cmath>

namespace hires_ros {
namespace {

namespace geometry = hires::geometry;

constexpr double kSameStamp = 5e-4;         // [s]
constexpr double kLocalisationWait = 0.15;  // [s] of odometry
constexpr double kHistory = 3.0;            // [s] that is kept
constexpr double kOldOrigin = 1.0;          // [s] after which odometry has drifted from it
constexpr double kTooOld = 2.0;             // [s] after which nobody waits any more
constexpr double kOldPosture = 0.05;        // [s] after which head and arms may be elsewhere
constexpr double kJumpBack = 1.0;           // [s] by which time must go back to have begun anew

template <typename Deque>
void Insert(Deque* deque, typename Deque::value_type item) {
  const auto place =
      std::upper_bound(deque->begin(), deque->end(), item.stamp,
                       [](double stamp, const auto& one) { return stamp < one.stamp; });
  deque->insert(place, std::move(item));
  while (deque->back().stamp - deque->front().stamp > kHistory) deque->pop_front();
}

/// What is nearest in time; none farther than `reach` [s].
template <typename Deque>
const typename Deque::value_type* Nearest(const Deque& deque, double stamp, double reach) {
  const typename Deque::value_type* nearest = nullptr;
  for (const auto& one : deque) {
    const bool is_nearer =
        nearest == nullptr || std::abs(one.stamp - stamp) < std::abs(nearest->stamp - stamp);
    if (is_nearer) nearest = &one;
  }
  return nearest && std::abs(nearest->stamp - stamp) <= reach ? nearest : nullptr;
}

}  // namespace

/// A clock that begins anew (a simulation that is started again) makes all older stamps worthless.
void TrackerSenses::NoteTime(double stamp) {
  if (!odometry_.empty() && stamp < odometry_.back().stamp - kJumpBack - kHistory) Forget();
}

void TrackerSenses::Forget() {
  odometry_.clear();
  localisation_.clear();
  origins_.clear();
  pending_.clear();
  late_.clear();
  postures_.clear();
  newest_joints_.reset();
  why_dropped_.clear();
  taken_ = -1.0;
}

void TrackerSenses::OnOdometry(double stamp, const OdometryReading& reading) {
  NoteTime(stamp);
  Insert(&odometry_, {stamp, reading});
}

void TrackerSenses::OnLocalisation(double stamp, const geometry::Pose2& X_MB) {
  Insert(&localisation_, {stamp, X_MB});
}

void TrackerSenses::OnOdometryOrigin(double stamp, const geometry::Pose2& X_MO) {
  Insert(&origins_, {stamp, X_MO});
}

bool TrackerSenses::IsTaken(double stamp) const { return stamp <= taken_ - kSameStamp; }

TrackerSenses::Pending* TrackerSenses::PendingAt(double stamp) {
  if (IsTaken(stamp)) {
    ++num_dropped_;
    return nullptr;
  }
  const auto near = pending_.lower_bound(stamp - kSameStamp);
  if (near != pending_.end() && near->first <= stamp + kSameStamp) return &near->second;
  return &pending_[stamp];
}

void TrackerSenses::OnJoints(double stamp, hires::robot::JointPositions joints) {
  newest_joints_ = std::max(newest_joints_.value_or(stamp), stamp);
  if (Pending* pending = PendingAt(stamp)) pending->joints = std::move(joints);
}

void TrackerSenses::OnLook(double stamp, std::vector<hires::perception::Detection> detections) {
  if (IsTaken(stamp)) return late_.push_back({stamp, std::move(detections)});
  PendingAt(stamp)->look = std::move(detections);
}

/// The reading nearest in time, as long as it is near.
const OdometryReading* TrackerSenses::OdometryAt(double stamp) const {
  const auto* nearest = Nearest(odometry_, stamp, 0.1);
  return nearest ? &nearest->value : nullptr;
}

/// The last correction of the odometry, and the odometry since then.
std::optional<geometry::Pose2> TrackerSenses::BaseAt(double stamp) const {
  const OdometryReading* now = OdometryAt(stamp);
  if (now == nullptr) return std::nullopt;
  for (auto one = localisation_.rbegin(); one != localisation_.rend(); ++one) {
    if (one->stamp > stamp + kSameStamp) continue;
    const OdometryReading* then = OdometryAt(one->stamp);
    if (then) return map_to_world_.ToWorld(one->value * then->X_OB.Inverse() * now->X_OB);
  }
  const auto* X_MO = Nearest(origins_, stamp, kOldOrigin);
  if (X_MO == nullptr) return std::nullopt;
  return map_to_world_.ToWorld(X_MO->value * now->X_OB);
}

/// What a moment still waits for; empty: it is complete.
std::string TrackerSenses::Lack(double stamp, const Pending& pending) const {
  if (odometry_.empty() || odometry_.back().stamp < stamp - kSameStamp) return "odometry";
  if (!newest_joints_ || *newest_joints_ < stamp - kSameStamp) return "joint states";
  if (!pending.joints && postures_.empty()) return "joint states";
  const bool is_corrected =
      !localisation_.empty() && localisation_.back().stamp >= stamp - kSameStamp;
  if (!is_corrected && odometry_.back().stamp < stamp + kLocalisationWait) return "odometry";
  if (OdometryAt(stamp) == nullptr) return "odometry of that time";
  return BaseAt(stamp) ? "" : "localisation";
}

bool TrackerSenses::IsHopeless(double stamp) const {
  const double newest = std::max(odometry_.empty() ? stamp : odometry_.back().stamp,
                                 pending_.empty() ? stamp : pending_.rbegin()->first);
  return newest - stamp > kTooOld;
}

/// Joints that are older: nobody knows where the camera looked then.
const hires::robot::JointPositions* TrackerSenses::PostureAt(double stamp) const {
  const auto* nearest = Nearest(postures_, stamp, kOldPosture);
  return nearest ? &nearest->value : nullptr;
}

std::optional<TrackerMoment> TrackerSenses::TakeLate() {
  while (!late_.empty()) {
    const auto [stamp, look] = late_.front();
    late_.pop_front();
    const hires::robot::JointPositions* posture = PostureAt(stamp);
    const auto X_MB = BaseAt(stamp);
    if (posture && X_MB) {
      return TrackerMoment{{stamp, *X_MB, *posture}, OdometryAt(stamp)->V_B, look, true};
    }
    ++num_dropped_;
  }
  return std::nullopt;
}

std::optional<TrackerMoment> TrackerSenses::Take() {
  if (auto late = TakeLate()) return late;
  while (!pending_.empty()) {
    const auto first = pending_.begin();
    const double stamp = first->first;
    const std::string lack = Lack(stamp, first->second);
    if (!lack.empty()) {
      if (!IsHopeless(stamp)) return std::nullopt;
      ++num_dropped_;
      why_dropped_ = lack;
      pending_.erase(first);
      continue;
    }
    if (first->second.joints) Insert(&postures_, {stamp, *first->second.joints});
    TrackerMoment moment;
    moment.body = {stamp, *BaseAt(stamp), postures_.back().value};
    moment.V_B = OdometryAt(stamp)->V_B;
    const bool is_posture_known = PostureAt(stamp) != nullptr;
    if (is_posture_known) moment.look = std::move(first->second.look);
    if (!is_posture_known && first->second.look) ++num_dropped_;
    taken_ = stamp;
    why_dropped_.clear();
    pending_.erase(first);
    return moment;
  }
  return std::nullopt;
}

std::string TrackerSenses::Missing() const {
  if (odometry_.empty()) return "odometry";
  if (localisation_.empty() && origins_.empty()) return "localisation";
  if (!newest_joints_) return "joint states";
  return why_dropped_;
}

}  // namespace hires_ros
