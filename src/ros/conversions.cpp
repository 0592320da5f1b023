#include "hires/ros/conversions.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "hires/base/error.h"
#include "hires/geometry/angles.h"

namespace hires_ros {
namespace {

using hires::geometry::Pose3;
using hires::imagination::ImaginationOutcome;
using hires::imagination::IntervalKind;

geometry_msgs::Twist TwistMsg(const hires::geometry::Twist3& twist) {
  geometry_msgs::Twist out;
  out.linear.x = twist.linear.x();
  out.linear.y = twist.linear.y();
  out.linear.z = twist.linear.z();
  out.angular.x = twist.angular.x();
  out.angular.y = twist.angular.y();
  out.angular.z = twist.angular.z();
  return out;
}

hires::geometry::Twist3 FromTwistMsg(const geometry_msgs::Twist& twist) {
  return {{twist.linear.x, twist.linear.y, twist.linear.z},
          {twist.angular.x, twist.angular.y, twist.angular.z}};
}

std::uint8_t OutcomeCode(const hires::imagination::Report& report) {
  switch (report.outcome == ImaginationOutcome::kCancelled ? report.found : report.outcome) {
    case ImaginationOutcome::kRanked:
      return report.complete ? msg::ImagineResult::RANKED : msg::ImagineResult::RANKED_AT_DEADLINE;
    case ImaginationOutcome::kAllFailed:
      return msg::ImagineResult::ALL_FAILED;
    case ImaginationOutcome::kUndecided:
      return msg::ImagineResult::UNDECIDED;
    case ImaginationOutcome::kNoWorker:
      return msg::ImagineResult::NO_WORKER;
    case ImaginationOutcome::kNothingFinished:
      return msg::ImagineResult::NOTHING_FINISHED;
    case ImaginationOutcome::kCancelled:
      return msg::ImagineResult::CANCELLED;
  }
  return msg::ImagineResult::INVALID;
}

ImaginationOutcome OutcomeOf(std::uint8_t code) {
  switch (code) {
    case msg::ImagineResult::RANKED:
    case msg::ImagineResult::RANKED_AT_DEADLINE:
      return ImaginationOutcome::kRanked;
    case msg::ImagineResult::ALL_FAILED:
      return ImaginationOutcome::kAllFailed;
    case msg::ImagineResult::UNDECIDED:
      return ImaginationOutcome::kUndecided;
    case msg::ImagineResult::NO_WORKER:
      return ImaginationOutcome::kNoWorker;
    case msg::ImagineResult::NOTHING_FINISHED:
      return ImaginationOutcome::kNothingFinished;
    default:
      return ImaginationOutcome::kCancelled;
  }
}

std::uint8_t CodeOf(hires::world::Fall fall) {
  switch (fall) {
    case hires::world::Fall::kNone:
      return msg::ObjectTruth::NOT_FALLEN;
    case hires::world::Fall::kLost:
      return msg::ObjectTruth::LOST;
    case hires::world::Fall::kToppled:
      return msg::ObjectTruth::TOPPLED;
    case hires::world::Fall::kDropped:
      return msg::ObjectTruth::DROPPED;
    case hires::world::Fall::kSlid:
      return msg::ObjectTruth::SLID;
  }
  return msg::ObjectTruth::NOT_FALLEN;
}

hires::world::Fall FallOf(std::uint8_t code) {
  for (const auto fall :
       {hires::world::Fall::kNone, hires::world::Fall::kLost, hires::world::Fall::kToppled,
        hires::world::Fall::kDropped, hires::world::Fall::kSlid}) {
    if (CodeOf(fall) == code) return fall;
  }
  throw hires::base::ConfigError(fmt::format("first_fall of a thing is {}, wanted 0 .. 4", code));
}

hires::imagination::Outcome OutcomeOfRollout(std::uint8_t code) {
  switch (code) {
    case msg::RolloutRecord::SUCCEEDED:
      return hires::imagination::Outcome::kSucceeded;
    case msg::RolloutRecord::FAILED:
      return hires::imagination::Outcome::kFailed;
    case msg::RolloutRecord::TIMED_OUT:
      return hires::imagination::Outcome::kTimedOut;
    default:
      throw hires::base::ConfigError(
          fmt::format("outcome of a rollout is {}, wanted 0, 1 or 2", code));
  }
}

/// What the prediction itself knows of single rollouts: which ones they are.
void SetRollouts(const hires::imagination::Prediction& prediction, msg::Prediction* out) {
  const hires::imagination::Evidence& e = prediction.evidence;
  for (const auto& [cause, count] : e.first_causes) {
    msg::CauseCount entry;
    entry.cause = cause;
    entry.count = count;
    out->first_causes.push_back(entry);
  }
  const auto set = [&](int index, msg::RolloutRef* ref) {
    ref->action = out->action;
    ref->alternative = prediction.alternative;
    ref->index = static_cast<std::uint32_t>(index);  // -1: beyond every number of rollouts
  };
  set(e.worst_rollout, &out->worst);
  set(e.median_rollout, &out->median);
  set(e.first_failed, &out->first_failed);
}

void ReadRollouts(const msg::Prediction& prediction, hires::imagination::Prediction* out) {
  hires::imagination::Evidence& e = out->evidence;
  for (const msg::CauseCount& entry : prediction.first_causes) {
    e.first_causes[entry.cause] = entry.count;
  }
  const auto index_of = [&](const msg::RolloutRef& ref) {
    return ref.index < prediction.rollouts ? static_cast<int>(ref.index) : -1;
  };
  e.worst_rollout = index_of(prediction.worst);
  e.median_rollout = index_of(prediction.median);
  e.first_failed = index_of(prediction.first_failed);
  out->alternative = static_cast<int>(prediction.median.alternative);
}

IntervalKind KindOf(std::uint8_t code) {
  if (code == msg::Prediction::CLOPPER_PEARSON) return IntervalKind::kClopperPearson;
  if (code == msg::Prediction::CONFIDENCE_SEQUENCE) return IntervalKind::kConfidenceSequence;
  throw hires::base::ConfigError(
      fmt::format("interval_kind of a prediction is {}, wanted 0 or 1", code));
}

}  // namespace

geometry_msgs::Pose ToMsg(const Pose3& pose) {
  geometry_msgs::Pose out;
  out.position.x = pose.translation.x();
  out.position.y = pose.translation.y();
  out.position.z = pose.translation.z();
  out.orientation.x = pose.rotation.x();
  out.orientation.y = pose.rotation.y();
  out.orientation.z = pose.rotation.z();
  out.orientation.w = pose.rotation.w();
  return out;
}

Pose3 FromMsg(const geometry_msgs::Pose& pose) {
  const auto& q = pose.orientation;
  Pose3 out{{pose.position.x, pose.position.y, pose.position.z}, {q.w, q.x, q.y, q.z}};
  const double norm = out.rotation.norm();
  if (norm == 0.0) out.rotation.setIdentity();
  // A unit quaternion passes untouched: dividing by a norm of almost 1 would change its bits.
  if (norm > 0.0 && std::abs(norm - 1.0) > 1e-9) out.rotation.normalize();
  return out;
}

msg::ActionCall ToMsg(const hires::base::ActionCall& call) {
  msg::ActionCall out;
  out.name = call.name;
  out.arguments = call.arguments;
  return out;
}

hires::base::ActionCall FromMsg(const msg::ActionCall& call) { return {call.name, call.arguments}; }

msg::ActionTemplate ToMsg(const hires::base::ActionTemplate& action) {
  msg::ActionTemplate out;
  out.name = action.name;
  for (const auto& list : action.alternatives) {
    out.alternatives.emplace_back();
    out.alternatives.back().values = list;
  }
  return out;
}

hires::base::ActionTemplate FromMsg(const msg::ActionTemplate& action) {
  hires::base::ActionTemplate out{action.name, {}};
  for (const auto& list : action.alternatives) out.alternatives.push_back(list.values);
  return out;
}

msg::Failure ToMsg(const hires::base::Failure& failure) {
  msg::Failure out;
  out.code = static_cast<std::uint16_t>(failure.code);
  out.subjects = failure.subjects;
  out.detail = failure.detail;
  return out;
}

hires::base::Failure FromMsg(const msg::Failure& failure) {
  const auto code = hires::base::FailureCodeOf(failure.code);
  if (code) return {*code, failure.subjects, failure.detail};
  return {hires::base::FailureCode::kOther, failure.subjects,
          fmt::format("code {}, unknown to this version{}{}", failure.code,
                      failure.detail.empty() ? "" : ": ", failure.detail)};
}

msg::WorldState ToMsg(const hires::world::WorldState& state) {
  msg::WorldState out;
  out.header.frame_id = "map";
  for (const hires::world::ObjectState& object : state.objects) {
    msg::ObjectState entry;
    entry.name = object.name;
    entry.model = object.model;
    entry.pose = ToMsg(object.X_MO);
    entry.twist = TwistMsg(object.V_MO);
    entry.attached_to = object.attached_to;
    out.objects.push_back(entry);
  }
  return out;
}

hires::world::WorldState FromMsg(const msg::WorldState& state) {
  hires::world::WorldState out;
  for (const msg::ObjectState& entry : state.objects) {
    out.objects.push_back({entry.name, entry.model, FromMsg(entry.pose), FromTwistMsg(entry.twist),
                           entry.attached_to});
  }
  return out;
}

msg::RobotState ToMsg(const hires::robot::RobotState& state) {
  msg::RobotState out;
  out.pose.position.x = state.X_MB.x;
  out.pose.position.y = state.X_MB.y;
  out.pose.orientation.z = std::sin(state.X_MB.yaw / 2.0);
  out.pose.orientation.w = std::cos(state.X_MB.yaw / 2.0);
  out.yaw = state.X_MB.yaw;
  out.twist.linear.x = state.V_B.vx;
  out.twist.linear.y = state.V_B.vy;
  out.twist.angular.z = state.V_B.wz;
  for (const auto& [name, position] : state.joints) {
    out.joints.name.push_back(name);
    out.joints.position.push_back(position);
  }
  return out;
}

hires::robot::RobotState FromMsg(const msg::RobotState& state) {
  hires::robot::RobotState out;
  // Who fills in the pose alone leaves yaw at 0: it counts only where it says what the pose says.
  const double posed = hires::geometry::YawOf(FromMsg(state.pose).rotation);
  const bool fits = std::abs(hires::geometry::WrapToPi(posed - state.yaw)) < 1e-9;
  const double yaw = fits ? state.yaw : posed;
  out.X_MB = {state.pose.position.x, state.pose.position.y, yaw};
  out.V_B = {state.twist.linear.x, state.twist.linear.y, state.twist.angular.z};
  if (state.joints.name.size() != state.joints.position.size()) {
    throw hires::base::ConfigError("robot_state.joints: names and positions differ in number");
  }
  for (std::size_t i = 0; i < state.joints.name.size(); ++i) {
    out.joints[state.joints.name[i]] = state.joints.position[i];
  }
  return out;
}

msg::ObjectTruth ToMsg(const std::string& name, const hires::simulation::ObjectFate& fate) {
  msg::ObjectTruth out;
  out.name = name;
  out.pose = ToMsg(fate.X_MO);
  out.attached_to = fate.attached_to;
  out.stands = fate.stands;
  out.tilt = fate.tilt;
  out.max_tilt = fate.max_tilt;
  out.falls = static_cast<std::uint32_t>(fate.falls);
  out.first_fall = CodeOf(fate.first_fall);
  return out;
}

hires::simulation::ObjectFate FromMsg(const msg::ObjectTruth& truth) {
  hires::simulation::ObjectFate fate;
  fate.X_MO = FromMsg(truth.pose);
  fate.attached_to = truth.attached_to;
  fate.stands = truth.stands;
  fate.tilt = truth.tilt;
  fate.max_tilt = truth.max_tilt;
  fate.falls = static_cast<int>(truth.falls);
  fate.first_fall = FallOf(truth.first_fall);
  return fate;
}

void RequireSoundState(const msg::WorldState& world, const msg::RobotState& robot) {
  if (world.header.frame_id != "map") {
    throw hires::base::ConfigError(
        fmt::format("world_state.header.frame_id is '{}', wanted 'map'; give poses in map, or name "
                    "updated_fluents instead of a state",
                    world.header.frame_id));
  }
  const hires::geometry::Twist3 twist = FromTwistMsg(robot.twist);
  if (!twist.linear.allFinite() || !twist.angular.allFinite()) {
    throw hires::base::ConfigError("robot_state.twist is not finite; give numbers, 0 at rest");
  }
  if (!std::isfinite(robot.yaw)) {
    throw hires::base::ConfigError(
        "robot_state.yaw is not finite; leave it at 0 to let the pose say the heading");
  }
  for (std::size_t i = 0; i < robot.joints.position.size(); ++i) {
    if (std::isfinite(robot.joints.position[i])) continue;
    throw hires::base::ConfigError(
        fmt::format("robot_state.joints: position {} is not finite; give numbers", i));
  }
}

msg::RolloutRecord ToMsg(const hires::imagination::RolloutResult& result, int index) {
  msg::RolloutRecord out;
  out.index = index;
  out.outcome = static_cast<std::uint8_t>(result.outcome);
  out.failure = ToMsg(result.failure);
  out.duration = result.duration;
  out.counts.notopple = result.counts.notopple;
  out.counts.shaking = result.counts.shaking;
  out.counts.topple = result.counts.topple;
  out.falls = result.falls;
  out.max_tilt = result.max_tilt;
  out.first_cause = result.first_cause;
  out.action_finished = result.action_finished;
  out.nothing_watched = result.nothing_watched;
  out.final_world = ToMsg(result.final_world);
  out.final_robot = ToMsg(result.final_robot);
  out.simulated = result.simulated;
  out.depends_on_everything = result.reach.is_everything;
  for (const auto& disc : result.reach.discs) {
    out.reach.emplace_back();
    out.reach.back().x = disc.p_M.x();
    out.reach.back().y = disc.p_M.y();
    out.reach.back().radius = disc.radius;
  }
  return out;
}

hires::imagination::RolloutResult FromMsg(const msg::RolloutRecord& record) {
  hires::imagination::RolloutResult out;
  out.outcome = OutcomeOfRollout(record.outcome);
  out.failure = FromMsg(record.failure);
  out.duration = record.duration;
  out.counts.notopple = record.counts.notopple;
  out.counts.shaking = record.counts.shaking;
  out.counts.topple = record.counts.topple;
  out.falls = record.falls;
  out.max_tilt = record.max_tilt;
  out.first_cause = record.first_cause;
  out.action_finished = record.action_finished;
  out.nothing_watched = record.nothing_watched;
  out.final_world = FromMsg(record.final_world);
  out.final_robot = FromMsg(record.final_robot);
  out.simulated = record.simulated;
  out.reach.is_everything = record.depends_on_everything;
  for (const msg::Disc& disc : record.reach) {
    out.reach.discs.push_back({{disc.x, disc.y}, disc.radius});
  }
  return out;
}

msg::Prediction ToMsg(const hires::imagination::Prediction& prediction) {
  const hires::imagination::Evidence& e = prediction.evidence;
  msg::Prediction out;
  out.action = ToMsg(prediction.action);
  out.confidence_pooled = e.confidence_pooled;
  out.confidence_mean = e.confidence_mean;
  out.success_share = e.success.share;
  out.success_lower = e.success.lower;
  out.success_upper = e.success.upper;
  out.interval_kind = e.success.kind == IntervalKind::kClopperPearson
                          ? msg::Prediction::CLOPPER_PEARSON
                          : msg::Prediction::CONFIDENCE_SEQUENCE;
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  const auto cost = e.cost.value_or(hires::imagination::ExpectedCost{unknown, unknown, unknown});
  out.expected_cost = cost.mean;
  out.cost_lower = cost.lower;
  out.cost_upper = cost.upper;
  out.fall_share = e.fall_share;
  out.action_failed_share = e.action_failed_share;
  out.counts.notopple = e.counts.notopple;
  out.counts.shaking = e.counts.shaking;
  out.counts.topple = e.counts.topple;
  out.falls = e.falls;
  out.duration_mean = e.duration.mean;
  out.duration_sd = e.duration.sd;
  out.duration_p50 = e.duration.p50;
  out.duration_p95 = e.duration.p95;
  out.durations = e.durations;
  out.max_tilt_p50 = e.max_tilt.p50;
  out.max_tilt_p95 = e.max_tilt.p95;
  out.max_tilts = e.max_tilts;
  out.rollouts = e.num_rollouts;
  for (const auto& [failure, count] : e.failures) {
    out.failures.emplace_back();
    out.failures.back().failure = ToMsg(failure);
    out.failures.back().count = count;
  }
  SetRollouts(prediction, &out);
  out.final_world = ToMsg(prediction.final_world);
  out.final_robot = ToMsg(prediction.final_robot);
  return out;
}

hires::imagination::Prediction FromMsg(const msg::Prediction& prediction) {
  hires::imagination::Prediction out;
  out.action = FromMsg(prediction.action);
  hires::imagination::Evidence& e = out.evidence;
  e.confidence_pooled = prediction.confidence_pooled;
  e.confidence_mean = prediction.confidence_mean;
  e.num_rollouts = prediction.rollouts;
  e.success = {prediction.success_share, prediction.success_lower, prediction.success_upper,
               e.num_rollouts, KindOf(prediction.interval_kind)};
  if (!std::isnan(prediction.expected_cost)) {
    e.cost = {prediction.expected_cost, prediction.cost_lower, prediction.cost_upper};
  }
  e.fall_share = prediction.fall_share;
  e.action_failed_share = prediction.action_failed_share;
  e.counts.notopple = prediction.counts.notopple;
  e.counts.shaking = prediction.counts.shaking;
  e.counts.topple = prediction.counts.topple;
  e.falls = prediction.falls;
  e.duration = {prediction.duration_mean, prediction.duration_sd, prediction.duration_p50,
                prediction.duration_p95};
  e.durations = prediction.durations;
  e.max_tilt = {prediction.max_tilt_p50, prediction.max_tilt_p95};
  e.max_tilts = prediction.max_tilts;
  if (const std::string defect = DefectOf(e); !defect.empty()) {
    throw hires::base::ConfigError(
        fmt::format("the prediction of {}: {}; is the imagination client of this version?",
                    hires::base::ToString(out.action), defect));
  }
  for (const msg::FailureCount& failure : prediction.failures) {
    e.failures[FromMsg(failure.failure)] += failure.count;
  }
  ReadRollouts(prediction, &out);
  out.final_world = FromMsg(prediction.final_world);
  out.final_robot = FromMsg(prediction.final_robot);
  return out;
}

msg::ImagineResult ToMsg(const hires::imagination::Report& report) {
  msg::ImagineResult out;
  out.outcome = OutcomeCode(report);
  for (const auto& prediction : report.ranking) out.predictions.push_back(ToMsg(prediction));
  out.recommended = report.recommended;
  out.why = report.why;
  out.caveats = report.caveats;
  out.seed = report.seed;
  out.wall_seconds = report.wall_seconds;
  out.simulated_seconds = report.simulated_seconds;
  out.rollouts_kept = static_cast<std::uint32_t>(report.kept.rollouts);
  out.simulated_seconds_kept = report.kept.simulated_seconds;
  return out;
}

hires::imagination::Report FromMsg(const msg::ImagineResult& result) {
  if (result.outcome == msg::ImagineResult::INVALID) throw hires::base::ConfigError(result.why);
  hires::imagination::Report out;
  out.outcome = out.found = OutcomeOf(result.outcome);
  out.complete = result.outcome == msg::ImagineResult::RANKED ||
                 result.outcome == msg::ImagineResult::ALL_FAILED;
  for (const auto& prediction : result.predictions) out.ranking.push_back(FromMsg(prediction));
  out.recommended = result.recommended;
  out.why = result.why;
  out.caveats = result.caveats;
  out.seed = result.seed;
  out.wall_seconds = result.wall_seconds;
  out.simulated_seconds = result.simulated_seconds;
  out.kept = {static_cast<int>(result.rollouts_kept), result.simulated_seconds_kept};
  return out;
}

msg::ImagineFeedback ToMsg(const hires::imagination::Interim& interim) {
  msg::ImagineFeedback out;
  out.rollouts_done = interim.progress.done;
  out.rollouts_wanted = interim.progress.total;
  out.seconds_left = interim.progress.time_left.value_or(-1.0);
  out.workers = interim.num_workers;
  for (const auto& prediction : interim.ranking) out.predictions.push_back(ToMsg(prediction));
  return out;
}

hires::imagination::Interim FromMsg(const msg::ImagineFeedback& feedback) {
  hires::imagination::Interim out;
  out.progress.done = feedback.rollouts_done;
  out.progress.total = feedback.rollouts_wanted;
  out.progress.fraction =
      feedback.rollouts_wanted > 0
          ? static_cast<double>(feedback.rollouts_done) / feedback.rollouts_wanted
          : 0.0;
  if (feedback.seconds_left >= 0.0) out.progress.time_left = feedback.seconds_left;
  out.num_workers = feedback.workers;
  for (const auto& prediction : feedback.predictions) out.ranking.push_back(FromMsg(prediction));
  return out;
}

}  // namespace hires_ros
