#include "hires/ros/answer/report_messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hires/base/error.h"
#include "hires/ros/robot/robot_state_messages.h"
#include "hires/ros/values/action_messages.h"
#include "hires/ros/values/failure_messages.h"
#include "hires/ros/world/world_messages.h"

namespace hires_ros {
namespace {

using hires::imagination::ImaginationOutcome;
using hires::imagination::IntervalKind;

std::uint8_t OutcomeCode(const hires::imagination::Report& report) {
  switch (report.outcome == ImaginationOutcome::kCancelled ? report.found : report.outcome) {
    case ImaginationOutcome::kRanked:
      return report.complete ? msg::ImagineResult::RANKED : msg::ImagineResult::RANKED_AT_DEADLINE;
    case ImaginationOutcome::kClose:
      return msg::ImagineResult::CLOSE;
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
    case msg::ImagineResult::CLOSE:
      return ImaginationOutcome::kClose;
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

msg::CostReasons ToMsg(const hires::imagination::CostReasons& reasons) {
  msg::CostReasons out;
  for (const auto& [code, price] : reasons.prices) {
    out.failures.push_back(static_cast<std::uint16_t>(code));
    out.prices.push_back(price);
  }
  const auto next = reasons.next.value_or(hires::imagination::CostComparison());
  out.next = next.other;
  out.time_saved = next.time_saved;
  out.failures_more = next.failures_more;
  out.failures_more_upper = next.failures_more_upper;
  out.neither_failed = next.neither_failed;
  out.probability = next.probability;
  const auto turning = reasons.turning.value_or(hires::imagination::TurningPrice());
  out.turning_failure = static_cast<std::uint16_t>(turning.code);
  out.turning_price = turning.price;
  out.turns_below = turning.is_below;
  out.turning_place = turning.other;
  return out;
}

hires::imagination::CostReasons FromMsg(const msg::CostReasons& reasons) {
  hires::imagination::CostReasons out;
  for (std::size_t i = 0; i < std::min(reasons.failures.size(), reasons.prices.size()); ++i) {
    const auto code = hires::base::FailureCodeOf(reasons.failures[i]);
    if (code) out.prices[*code] = reasons.prices[i];
  }
  if (reasons.next >= 0) {
    out.next = hires::imagination::CostComparison{reasons.next,
                                                  reasons.time_saved,
                                                  reasons.failures_more,
                                                  reasons.failures_more_upper,
                                                  reasons.neither_failed != 0,
                                                  reasons.probability};
  }
  const auto turning = hires::base::FailureCodeOf(reasons.turning_failure);
  if (turning && *turning != hires::base::FailureCode::kNone) {
    out.turning = hires::imagination::TurningPrice{*turning, reasons.turning_price,
                                                   reasons.turns_below != 0, reasons.turning_place};
  }
  return out;
}

msg::ImagineResult ToMsg(const hires::imagination::Report& report) {
  msg::ImagineResult out;
  out.outcome = OutcomeCode(report);
  for (const auto& prediction : report.ranking) out.predictions.push_back(ToMsg(prediction));
  out.recommended = report.recommended;
  out.why = report.why;
  out.complete = report.complete;
  if (report.by_cost) {
    out.by_cost.push_back(ToMsg(*report.by_cost));
    out.probability_best = report.by_cost->probability;
    out.expected_regret = report.by_cost->regret;
    out.rollouts_to_settle = static_cast<std::uint32_t>(report.by_cost->until_settled.value_or(0));
  }
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
  out.complete = result.complete || result.outcome == msg::ImagineResult::RANKED;
  for (const auto& prediction : result.predictions) out.ranking.push_back(FromMsg(prediction));
  out.recommended = result.recommended;
  out.why = result.why;
  if (!result.by_cost.empty()) {
    out.by_cost = FromMsg(result.by_cost.front());
    out.by_cost->probability = result.probability_best;
    out.by_cost->regret = result.expected_regret;
    if (result.rollouts_to_settle > 0) out.by_cost->until_settled = result.rollouts_to_settle;
  }
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
