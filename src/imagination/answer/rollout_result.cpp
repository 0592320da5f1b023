#include "hires/imagination/rollout_result.h"

#include <fmt/format.h>

#include <cmath>
#include <tuple>

namespace hires::imagination {
namespace {

auto Counted(const RolloutResult& result) {
  return std::tie(result.outcome, result.failure, result.duration, result.counts, result.falls,
                  result.max_tilt, result.first_cause, result.action_finished,
                  result.nothing_watched);
}

std::string NumberDefect(const char* name, double value, const char* unit) {
  if (std::isfinite(value) && value >= 0.0) return {};
  return fmt::format("{} is {} {}, wanted a finite number >= 0", name, value, unit);
}

std::string CountDefect(const RolloutResult& result) {
  const OutcomeCounts& counts = result.counts;
  if (result.nothing_watched && counts.total() != 0) {
    return fmt::format("nothing was watched, but there are {} samples", counts.total());
  }
  if (counts.notopple >= 0 && counts.shaking >= 0 && counts.topple >= 0 && result.falls >= 0) {
    return {};
  }
  return fmt::format("a count is negative (notopple {}, shaking {}, topple {}, falls {})",
                     counts.notopple, counts.shaking, counts.topple, result.falls);
}

std::string ReachDefect(const RolloutReach& reach) {
  if (reach.is_everything != reach.discs.empty()) {
    return reach.is_everything ? "it depends on everything and on discs besides"
                               : "it depends on nothing: no disc of what it reached";
  }
  for (const RolloutReach::Disc& disc : reach.discs) {
    const bool is_sound = disc.p_M.allFinite() && std::isfinite(disc.radius) && disc.radius >= 0.0;
    if (is_sound) continue;
    return fmt::format(
        "it reached a disc of {} m around ({}, {}), wanted finite numbers, radius "
        ">= 0",
        disc.radius, disc.p_M.x(), disc.p_M.y());
  }
  return {};
}

std::string FinalDefect(const RolloutResult& result) {
  if (!result.final_robot.X_MB.IsFinite()) return "the robot's final pose is not finite";
  for (const world::ObjectState& object : result.final_world.objects) {
    if (!object.X_MO.IsFinite()) return "the final pose of " + object.name + " is not finite";
  }
  return {};
}

bool LacksSamples(const RolloutResult& result) {
  return result.counts.total() == 0 && !result.nothing_watched;
}

}  // namespace

OutcomeCounts& OutcomeCounts::operator+=(const OutcomeCounts& other) {
  notopple += other.notopple;
  shaking += other.shaking;
  topple += other.topple;
  return *this;
}

bool OutcomeCounts::operator==(const OutcomeCounts& other) const {
  return notopple == other.notopple && shaking == other.shaking && topple == other.topple;
}

bool ActionFailed(const RolloutResult& result) {
  return !result.action_finished || LacksSamples(result);
}

base::Failure FailureOf(const RolloutResult& result) {
  using Code = base::FailureCode;
  if (result.outcome != Outcome::kSucceeded && result.failure) return result.failure;
  if (result.outcome == Outcome::kTimedOut) return Code::kTimedOut;
  if (!result.action_finished) return Code::kUnfinished;
  if (result.falls > 0) return Code::kObjectFell;
  if (LacksSamples(result)) return Code::kNoSamples;
  if (result.outcome == Outcome::kSucceeded) return {};
  return {Code::kOther, {}, "no reason was given"};
}

std::string Defect(const RolloutResult& result) {
  std::string defect = CountDefect(result);
  if (defect.empty()) defect = NumberDefect("duration", result.duration, "s");
  if (defect.empty()) defect = NumberDefect("max_tilt", result.max_tilt, "rad");
  if (defect.empty()) defect = NumberDefect("simulated", result.simulated, "s");
  if (defect.empty()) defect = ReachDefect(result.reach);
  if (defect.empty()) defect = FinalDefect(result);
  return defect;
}

bool SameOutcome(const RolloutResult& a, const RolloutResult& b) {
  return Counted(a) == Counted(b);
}

}  // namespace hires::imagination
