#include "hires/sensing/robot_state_estimator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/geometry/angles.h"

namespace hires::sensing {
namespace {

using geometry::Pose2;
using geometry::Pose3;
using geometry::Twist2;

constexpr double kJumpBack = 1.0;  // [s] by which odometry is behind when its clock began again ...
constexpr int kSureJump = 5;       // ... if so many readings in a row are, or one is older than all
constexpr double kNear = 0.1;      // [s] from a reading with which a moment beyond it makes do
constexpr double kForever = std::numeric_limits<double>::infinity();

bool IsFinite(const Twist2& V) {
  return std::isfinite(V.vx) && std::isfinite(V.vy) && std::isfinite(V.wz);
}

bool IsStamp(double stamp) { return std::isfinite(stamp) && stamp > 0.0; }

Pose2 Between(const Pose2& from, const Pose2& to, double share) {
  return {from.x + share * (to.x - from.x), from.y + share * (to.y - from.y),
          geometry::WrapToPi(from.yaw + share * geometry::WrapToPi(to.yaw - from.yaw))};
}

robot::OdometryReading Between(const robot::OdometryReading& from, const robot::OdometryReading& to,
                               double share) {
  const Twist2 &a = from.V_B, &b = to.V_B;
  return {
      Between(from.X_OB, to.X_OB, share),
      {a.vx + share * (b.vx - a.vx), a.vy + share * (b.vy - a.vy), a.wz + share * (b.wz - a.wz)}};
}

}  // namespace

Receipt ReceiptOf(FrameStatus status, const std::string& frame) {
  switch (status) {
    case FrameStatus::kFound:
      return {};
    case FrameStatus::kUnknown:
      return {Reception::kUnknownFrame, frame};
    case FrameStatus::kNotConnected:
      return {Reception::kNotConnected, frame};
    case FrameStatus::kNotThen:
      return {Reception::kNotThen, frame};
    case FrameStatus::kInLoop:
      return {Reception::kInLoop, frame};
  }
  return {Reception::kUnknownFrame, frame};
}

bool StateParams::operator==(const StateParams& other) const {
  return history == other.history && stale_after == other.stale_after &&
         correction_wait == other.correction_wait && posture_reach == other.posture_reach;
}

bool Receipt::is_bad() const {
  return what != Reception::kTaken && what != Reception::kRepeated && what != Reception::kLate;
}

std::string ToString(const Receipt& receipt) {
  switch (receipt.what) {
    case Reception::kTaken:
      return "";
    case Reception::kRepeated:
      return "it came before";
    case Reception::kLate:
      return fmt::format("it is more than {:g} s late", receipt.limit);
    case Reception::kAhead:
      return fmt::format(
          "{} is more than {:g} s ahead of the odometry; synchronise the clocks of the computers",
          receipt.subject, receipt.limit);
    case Reception::kNoStamp:
      return "header.stamp is 0 or no number, wanted the time of the measurement";
    case Reception::kNotFinite:
      return fmt::format("{} is not finite, wanted a number", receipt.subject);
    case Reception::kUnknownFrame:
      return fmt::format(
          "frame '{}' is unknown to tf; name one that is connected with the robot, or publish it",
          receipt.subject);
    case Reception::kNotConnected:
      return fmt::format(
          "frame '{}' is not connected with the robot's frames; publish the transform between",
          receipt.subject);
    case Reception::kNotThen:
      return fmt::format(
          "where frame '{}' was at header.stamp is not known to tf, only at other times; publish "
          "its "
          "transforms more often, and look whether the clocks of the computers agree",
          receipt.subject);
    case Reception::kInLoop:
      return fmt::format(
          "the transforms above frame '{}' lead in a circle; end the node that publishes one of "
          "them",
          receipt.subject);
    case Reception::kTilted:
      return fmt::format(
          "the laser '{}' is tilted by more than {:g} rad in the base's frame, wanted a level one, "
          "or one upside down; mend the transform that says how it is mounted, or name another "
          "laser",
          receipt.subject, receipt.limit);
  }
  return "";
}

RobotStateEstimator::RobotStateEstimator(std::shared_ptr<const robot::Robot> robot,
                                         FrameNames frames, const StateParams& params,
                                         const geometry::MapToWorld& map_to_world,
                                         std::shared_ptr<FrameTree> tree)
    : robot_(std::move(robot)),
      frames_(std::move(frames)),
      params_(params),
      map_to_world_(map_to_world),
      tree_(std::move(tree)),
      joints_(robot_) {}

// ---- The clock.

std::optional<double> RobotStateEstimator::now() const {
  if (raw_.empty()) return std::nullopt;
  return raw_.back().stamp;
}

bool RobotStateEstimator::IsAhead(double stamp) const {
  return now() && stamp > *now() + params_.history;
}

bool RobotStateEstimator::IsLate(double stamp) const {
  return now() && stamp < *now() - params_.history;
}

Receipt RobotStateEstimator::Late() const { return {Reception::kLate, {}, params_.history}; }

Receipt RobotStateEstimator::Ahead(const std::string& subject) const {
  return {Reception::kAhead, subject, params_.history};
}

/// A clock that began again, and not a message that comes late.
bool RobotStateEstimator::HasClockRestarted(double stamp) {
  num_behind_ = now() && stamp < *now() - kJumpBack ? num_behind_ + 1 : 0;
  return num_behind_ >= kSureJump || (now() && stamp < *now() - params_.history - kJumpBack);
}

void RobotStateEstimator::Restart() {
  num_behind_ = 0;
  raw_.Clear();
  base_in_odometry_.Clear();
  corrections_.Clear();
  joints_.Clear();
  early_joints_.reset();
  early_transforms_.reset();
  tree_->ForgetMoving();
  ++num_restarts_;
}

void RobotStateEstimator::ForgetOld() {
  const double oldest = *now() - params_.history, latest = *now() + params_.history;
  raw_.KeepBetween(oldest, latest);
  base_in_odometry_.KeepBetween(oldest, latest);
  corrections_.KeepBetween(oldest, latest);
  joints_.KeepBetween(oldest, latest);
}

/// What is known of a time far ahead is of another clock, of a robot that has ended, say: tf holds
/// it for the newest, and refuses all that comes as too old.
void RobotStateEstimator::ForgetAhead() {
  const std::pair<const std::string&, const std::string&> links[] = {
      {frames_.map, frames_.odometry},
      {frames_.map, frames_.base},
      {frames_.odometry, frames_.base}};
  for (const auto& [parent, child] : links) {
    const auto newest = tree_->NewestOf(parent, child);
    if (!newest || !std::isfinite(*newest) || !IsAhead(*newest)) continue;
    early_transforms_.reset();
    return tree_->ForgetMoving();
  }
}

/// The odometry may come last: what was told once for a time that it has reached now is not told
/// again where the robot stands still.
void RobotStateEstimator::TakeEarly() {
  if (early_joints_ && !IsAhead(early_joints_->first)) {
    const auto [stamp, reading] = *std::exchange(early_joints_, std::nullopt);
    OnJoints(stamp, reading);
  }
  if (early_transforms_ && !IsAhead(*early_transforms_)) {
    OnTransforms(*std::exchange(early_transforms_, std::nullopt));
  }
}

// ---- What comes in.

Receipt RobotStateEstimator::OnOdometry(double stamp, const std::string& frame,
                                        const std::string& child,
                                        const robot::OdometryReading& reading) {
  if (!IsStamp(stamp)) return {Reception::kNoStamp, {}};
  if (!reading.X_OB.IsFinite()) return {Reception::kNotFinite, "pose"};
  if (!IsFinite(reading.V_B)) return {Reception::kNotFinite, "twist"};
  if (frame.empty()) return {Reception::kUnknownFrame, {}};
  const FramePose offset = ChildToBase(BareFrame(child), stamp);
  if (!offset.is_found()) return ReceiptOf(offset.status, child);
  if (HasClockRestarted(stamp)) Restart();
  if (IsLate(stamp)) return Late();
  if (BareFrame(frame) != raw_frame_) raw_.Clear();
  raw_frame_ = BareFrame(frame);
  const Pose2 X_CB = geometry::Flatten(offset.X_PC);
  const bool is_base = X_CB.x == 0.0 && X_CB.y == 0.0 && X_CB.yaw == 0.0;  // bits stay as they came
  const bool is_new = raw_.Insert(
      stamp,
      is_base ? reading : robot::OdometryReading{reading.X_OB * X_CB, MovedTo(X_CB, reading.V_B)});
  ForgetOld();
  ForgetAhead();
  TakeEarly();
  return is_new ? CheckFrame(frame) : Receipt{Reception::kRepeated, {}};
}

FramePose RobotStateEstimator::ChildToBase(const std::string& child, double stamp) const {
  if (child.empty() || child == frames_.base || child == robot_->profile.base_link) {
    return {FrameStatus::kFound, {}};
  }
  if (const auto X_BC = LinkInBase(child, joints_.PostureOf({}))) {
    return {FrameStatus::kFound, X_BC->Inverse()};
  }
  const auto newest = tree_->NewestOf(child, frames_.base);
  return tree_->Find(child, frames_.base, std::min(stamp, newest.value_or(stamp)));
}

/// Whether the odometry's frame leads to the one that localisation corrects.
Receipt RobotStateEstimator::CheckFrame(const std::string& frame) const {
  const bool leads_on = !base_in_odometry_.empty() || is_base_corrected_;
  if (raw_frame_ == frames_.odometry || leads_on) return {};
  if (tree_->NewestOf(frames_.odometry, raw_frame_)) return {};
  return ReceiptOf(tree_->Find(frames_.odometry, raw_frame_, *now()).status, frame);
}

Receipt RobotStateEstimator::OnJoints(double stamp, const robot::JointReading& reading) {
  if (!IsStamp(stamp)) return {Reception::kNoStamp, {}};
  for (const auto* numbers : {&reading.positions, &reading.velocities}) {
    for (const auto& [name, number] : *numbers) {
      if (!std::isfinite(number)) return {Reception::kNotFinite, "joint '" + name + "'"};
    }
  }
  if (IsLate(stamp)) return Late();
  if (IsAhead(stamp)) {
    early_joints_.emplace(stamp, reading);
    return Ahead("header.stamp");
  }
  early_joints_.reset();
  const bool is_new = joints_.Insert(stamp, reading);
  if (!now()) joints_.KeepBetween(stamp - params_.history, kForever);
  return {is_new ? Reception::kTaken : Reception::kRepeated, {}};
}

Receipt RobotStateEstimator::OnTransforms(double stamp) {
  if (const auto newest = tree_->NewestOf(frames_.odometry, frames_.base)) {
    const double time = std::min(stamp, *newest);
    const FramePose X_OB = tree_->Find(frames_.odometry, frames_.base, time);
    if (X_OB.is_found() && !IsAhead(time)) {
      base_in_odometry_.Insert(time, geometry::Flatten(X_OB.X_PC));
    }
  }
  if (const auto newest = tree_->NewestOf(frames_.map, frames_.odometry)) {
    return TakeCorrection(frames_.odometry, *newest, stamp);
  }
  if (const auto newest = tree_->NewestOf(frames_.map, frames_.base)) {
    return TakeCorrection(frames_.base, *newest, stamp);
  }
  return {};
}

/// @param frame   that the map leads to: the odometry's, or where the tree does not know it the
/// base.
/// @param newest  [s] moment that is known of it.
Receipt RobotStateEstimator::TakeCorrection(const std::string& frame, double newest, double stamp) {
  const double time = std::min(stamp, newest);
  const FramePose found = tree_->Find(frames_.map, frame, time);
  if (!found.is_found()) return Late();
  const Pose2 X_MF = geometry::Flatten(found.X_PC);
  const bool is_of_base = frame == frames_.base;
  if (is_of_base != is_base_corrected_) corrections_.Clear();
  is_base_corrected_ = is_of_base;
  X_MOfixed_.reset();
  if (newest == kForever) {
    if (!is_of_base) X_MOfixed_ = X_MF;
    return {};
  }
  if (IsLate(time)) return Late();
  if (IsAhead(time)) {
    early_transforms_ = time;
    return Ahead(frames_.map + " -> " + frame);
  }
  const double lead = std::max(time - now().value_or(time), 0.0);
  const bool is_new = corrections_.Insert(time, {X_MF, time - std::min(lead, LeastLead()), lead});
  if (!now()) corrections_.KeepBetween(time - params_.history, kForever);
  return {is_new ? Reception::kTaken : Reception::kRepeated, {}};
}

// ---- What is known.

/// @param reach  [s] from a reading with which `time` makes do where it does not lie between two.
std::optional<robot::OdometryReading> RobotStateEstimator::RawAt(double time, double reach) const {
  const auto* before = raw_.Before(time);
  const auto* after = raw_.After(time);
  if (before && before->stamp == time) return before->value;
  if (before && after && after->stamp <= before->stamp + params_.stale_after) {
    const double share = (time - before->stamp) / (after->stamp - before->stamp);
    return Between(before->value, after->value, share);
  }
  const double since = before ? time - before->stamp : kForever;
  const double until = after ? after->stamp - time : kForever;
  if (std::min(since, until) > reach) return std::nullopt;
  return since <= until ? before->value : after->value;
}

/// Where the odometry's own frame R is in the odometry's frame of the tree: X_OR.
std::optional<Pose2> RobotStateEstimator::OdometryOrigin(double time) const {
  if (const auto newest = tree_->NewestOf(frames_.odometry, raw_frame_)) {
    const FramePose X_OR = tree_->Find(frames_.odometry, raw_frame_, std::min(time, *newest));
    if (!X_OR.is_found()) return std::nullopt;
    return geometry::Flatten(X_OR.X_PC);
  }
  const auto* told = base_in_odometry_.Before(time);
  if (told == nullptr) told = base_in_odometry_.After(time);
  if (told == nullptr && is_base_corrected_) return Pose2{};  // the tree knows neither frame
  const auto then = told ? RawAt(told->stamp, kNear) : std::nullopt;
  if (!then) return std::nullopt;
  return told->value * then->X_OB.Inverse();
}

/// By how much corrections are stamped ahead of their time [s]; one that is read before the
/// odometry of its time seems further ahead than it is.
double RobotStateEstimator::LeastLead() const {
  double least = kForever;
  for (const auto& one : corrections_) least = std::min(least, one.value.lead);
  return least;
}

std::optional<Pose2> RobotStateEstimator::CorrectionAt(double time) const {
  if (X_MOfixed_) return X_MOfixed_;
  const bool is_fresh = std::any_of(corrections_.begin(), corrections_.end(), [&](const auto& one) {
    const double heard = one.value.heard;
    return time <= heard + params_.stale_after && heard <= time + params_.stale_after;
  });
  if (!is_fresh) return std::nullopt;
  const auto* before = corrections_.Before(time);
  const auto* after = corrections_.After(time);
  const auto X_MObefore = before ? OffsetOf(before->value, before->stamp) : std::nullopt;
  const auto X_MOafter = after ? OffsetOf(after->value, after->stamp) : std::nullopt;
  if (!X_MObefore) return X_MOafter;
  if (!X_MOafter || before->stamp == time) return X_MObefore;
  const double share = (time - before->stamp) / (after->stamp - before->stamp);
  return Between(*X_MObefore, *X_MOafter, share);
}

/// Where the odometry's frame is in the map, by a correction; one of the base tells it together
/// with the odometry of its time, and nothing before that came.
std::optional<Pose2> RobotStateEstimator::OffsetOf(const Correction& correction,
                                                   double stamp) const {
  if (!is_base_corrected_) return correction.X_MF;
  const auto raw = RawAt(stamp, kNear);
  const auto X_OR = raw_frame_ == frames_.odometry ? Pose2{} : OdometryOrigin(stamp);
  if (!raw || !X_OR) return std::nullopt;
  return correction.X_MF * (*X_OR * raw->X_OB).Inverse();
}

Missing RobotStateEstimator::MissingAt(double time) const {
  if (!now() || time > *now() || !RawAt(time, kNear)) return Missing::kOdometry;
  const bool are_joints_known = !joints_.empty() && time <= joints_.newest() &&
                                joints_.DistanceTo(time) <= params_.stale_after;
  if (!are_joints_known) return Missing::kJointStates;
  if (raw_frame_ != frames_.odometry && !OdometryOrigin(time)) return Missing::kOdometryFrame;
  return CorrectionAt(time) ? Missing::kNothing : Missing::kLocalisation;
}

Missing RobotStateEstimator::MissingNow() const {
  if (raw_.empty()) return Missing::kOdometry;
  if (joints_.empty()) return Missing::kJointStates;
  return MissingAt(std::min(*now(), joints_.newest()));
}

std::optional<double> RobotStateEstimator::CompleteUntil() const {
  if (MissingNow() != Missing::kNothing) return std::nullopt;
  return std::min(*now(), joints_.newest());
}

bool RobotStateEstimator::IsSettled(double time) const {
  if (!now() || *now() < time || joints_.empty() || joints_.newest() < time) return false;
  if (LocalisedUntil().value_or(-kForever) >= time) return true;
  return *now() >= time + (CorrectionAt(time) ? params_.correction_wait : params_.history);
}

std::optional<double> RobotStateEstimator::LocalisedUntil() const {
  if (X_MOfixed_) return kForever;
  if (corrections_.empty()) return std::nullopt;
  return corrections_.back().stamp;
}

std::optional<RobotEstimate> RobotStateEstimator::At(double time) const {
  if (MissingAt(time) != Missing::kNothing) return std::nullopt;
  const robot::OdometryReading raw = *RawAt(time, kNear);
  RobotEstimate estimate;
  estimate.time = time;
  estimate.X_OB = raw_frame_ == frames_.odometry ? raw.X_OB : *OdometryOrigin(time) * raw.X_OB;
  estimate.X_MB = *CorrectionAt(time) * estimate.X_OB;
  estimate.X_WB = map_to_world_.ToWorld(estimate.X_MB);
  estimate.V_B = raw.V_B;
  robot::JointReading joints = joints_.At(time, params_.stale_after);
  estimate.joints = std::move(joints.positions);
  estimate.joint_velocities = std::move(joints.velocities);
  estimate.posture = joints_.PostureOf(estimate.joints);
  return estimate;
}

bool RobotStateEstimator::IsPostureKnown(double time) const {
  return joints_.DistanceTo(time) <= params_.posture_reach;
}

// ---- Frames.

std::optional<Pose3> RobotStateEstimator::LinkInBase(const std::string& link,
                                                     const robot::JointPositions& posture) const {
  const auto index = robot_->model.FindLink(link);
  const auto base = robot_->model.FindLink(robot_->profile.base_link);
  if (!index || !base) return std::nullopt;
  const auto X_RL = robot::ForwardKinematics(robot_->model, posture);
  return X_RL[*base].Inverse() * X_RL[*index];
}

FramePose RobotStateEstimator::InBase(const std::string& name, const RobotEstimate& at) const {
  const std::string frame = BareFrame(name);
  if (frame.empty()) return {};
  if (frame == frames_.base) return {FrameStatus::kFound, {}};
  if (const auto X_BL = LinkInBase(frame, at.posture)) return {FrameStatus::kFound, *X_BL};
  if (frame == frames_.map) return {FrameStatus::kFound, geometry::Lift(at.X_MB).Inverse()};
  if (frame == frames_.odometry) return {FrameStatus::kFound, geometry::Lift(at.X_OB).Inverse()};
  const FramePose X_BF = tree_->Find(frames_.base, frame, at.time);
  if (X_BF.is_found()) return X_BF;
  // The tree may not know yet where the robot is; what stands about hangs on the map.
  const FramePose X_MF = tree_->Find(frames_.map, frame, at.time);
  if (!X_MF.is_found()) return X_BF.status == FrameStatus::kUnknown ? X_MF : X_BF;
  return {FrameStatus::kFound, geometry::Lift(at.X_MB).Inverse() * X_MF.X_PC};
}

Pose3 RobotStateEstimator::LinkInWorld(const std::string& link, const RobotEstimate& at) const {
  if (link.empty()) return {};
  const auto X_BL = LinkInBase(link, at.posture);
  if (X_BL) return geometry::Lift(at.X_WB) * *X_BL;
  throw base::ConfigError(base::UnknownName("link", link, robot_->model.LinkNames()));
}

}  // namespace hires::sensing
