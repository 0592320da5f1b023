#include "step_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "hires/base/text.h"

namespace hires::execution {
namespace {

std::string ReasonOf(const StepFinished& finished) {
  switch (finished.result) {
    case StepFinished::Result::kSucceeded:
      return "";
    case StepFinished::Result::kFailed:
      return finished.reason.empty() ? "failed" : finished.reason;
    case StepFinished::Result::kPreempted:
      return "preempted";
    case StepFinished::Result::kUnavailable:
      return finished.reason.empty() ? "unavailable" : "unavailable: " + finished.reason;
  }
  return "failed";
}

/// Why the way that was taken is no good, as skills say it (docs/notes_skills.md): another arm or
/// place may do. Whatever else comes is of the robot (motors_halted, stale_scan, no_controller),
/// and no other way helps against it.
bool IsOfTheAction(const std::string& reason) {
  static const std::set<std::string> kReasons{
      "area_occupied",  "goal_blocked",        "goal_missed", "grasp_failed",    "hand_full",
      "no_path",        "no_valid_trajectory", "object_held", "object_not_seen", "object_slipped",
      "object_toppled", "oscillating",         "out_of_view", "start_blocked",   "stuck",
      "unreachable"};
  return kReasons.count(reason.substr(0, reason.find(':'))) > 0;
}

/// It will fail again however often it is tried from here: another way must be taken.
bool IsBlocked(const std::string& reason) {
  return reason.rfind("area_occupied", 0) == 0 || reason.rfind("unreachable", 0) == 0;
}

std::string TextOf(const Expectation& expectation) {
  const std::string atom = base::ToString(AtomOf(expectation.literal.atom));
  return expectation.literal.holds ? atom : "not " + atom;
}

}  // namespace

void StepWatch::OnFinished(const StepFinished& finished) {
  const int index = session_.has_plan() ? session_.run().FindActivity(finished.activity) : -1;
  if (index < 0) return;  // of a step that is over or was given up
  const std::string reason = ReasonOf(finished);
  if (reason.empty()) return session_.End(index, StepPhase::kChecking, "succeeded", "");
  const StepRun& step = session_.run().at(index);
  if (step.is_stopping) return session_.End(index, StepPhase::kFailed, "preempted", "stopped");
  session_.End(index, StepPhase::kFailed, "failed", reason);
  if (IsBlocked(reason)) session_.Exclude({step.action, NamesIn(reason), 0}, index, reason);
  session_.Report({Trouble::Kind::kActivity, step.action, reason, index, IsOfTheAction(reason)},
                  step.activity);
}

void StepWatch::Wake(double at) { wake_at_ = std::min(wake_at_.value_or(at), at); }

bool StepWatch::IsPast(double at) {
  if (session_.now() >= at) return true;
  Wake(at);
  return false;
}

void StepWatch::Check(bool with_later_steps) {
  wake_at_.reset();
  lost_.clear();
  still_broken_.clear();
  PlanRun& run = session_.run();
  for (const int step : run.Active()) {
    if (run.at(step).phase == StepPhase::kChecking) {
      CheckEffects(step);
    } else if (run.at(step).is_stopping) {
      CheckStop(step);
    } else {
      CheckDuration(step);
      CheckConditions(step);
    }
  }
  for (int step = 0; with_later_steps && step < run.size(); ++step) {
    if (run.at(step).IsWaiting()) CheckLinks(step);
  }
  broken_ = std::move(still_broken_);
}

/// Nobody knows what such a step still does: nothing may begin beside it.
void StepWatch::CheckStop(int index) {
  const StepRun& step = session_.run().at(index);
  if (!IsPast(*step.stopped + session_.params().stop_timeout)) return;
  lost_ = fmt::format("{} was told to stop and has not answered for {} s",
                      base::ToString(step.action), session_.params().stop_timeout);
  session_.Warning(lost_ + "; the robot may still move");
  session_.End(index, StepPhase::kFailed, "failed", "did not stop");
}

void StepWatch::CheckDuration(int index) {
  const StepRun& step = session_.run().at(index);
  if (!IsPast(*step.started + step.time_limit)) return;
  session_.Stop(index);
  session_.Report({Trouble::Kind::kTimeout, step.action, "timed_out"}, step.activity);
}

std::optional<std::string> StepWatch::MissingEffect(int index) const {
  const planning::PlanStep& planned = session_.run().planned(index);
  for (const Datum& atom : planned.adds) {
    if (!session_.facts().HoldsText(ToString(atom))) return base::ToString(AtomOf(atom));
  }
  for (const Datum& atom : planned.deletes) {
    if (session_.facts().HoldsText(ToString(atom))) return "not " + base::ToString(AtomOf(atom));
  }
  return std::nullopt;
}

void StepWatch::CheckEffects(int index) {
  const auto missing = MissingEffect(index);
  if (!missing) return session_.Confirm(index);
  StepRun& step = session_.run().at(index);
  const double due = *step.finished + session_.params().effect_timeout;
  if (!IsPast(due) || MayBeOnItsWay(due, base::ToString(step.action))) return;
  const std::string reason =
      (session_.IsBehind(due) ? "effect_unknown: " : "effect_missing: ") + *missing;
  step.phase = StepPhase::kFailed;
  step.note = reason;
  session_.Changed();
  session_.Report({Trouble::Kind::kEffect, step.action, reason}, step.activity);
}

/// What nobody has told yet is no proof that it is not so; but not for ever.
bool StepWatch::MayBeOnItsWay(double due, const std::string& action) {
  if (!session_.IsBehind(due)) {
    late_.erase(action);
    return false;
  }
  const MonitorParams& params = session_.params();
  // Word of what is observed always takes a moment: it is worth telling where it takes long.
  if (IsPast(due + params.effect_timeout) && late_.insert(action).second) {
    session_.Warning(
        fmt::format("{}: word of what is observed is {:.1f} s late; it is waited for up to {} s",
                    action, params.effect_timeout, params.observation_delay));
  }
  return !IsPast(due + params.observation_delay);
}

/// Whether a running step may have changed it for a while.
bool StepWatch::IsDisturbed(const Expectation& expectation) const {
  const PlanRun& run = session_.run();
  for (const int step : run.Active()) {
    if (run.at(step).disturbance.Touches(expectation.literal.atom)) return true;
  }
  return false;
}

/// Since when it does not hold [s], undisturbed.
std::optional<double> StepWatch::BrokenSince(const Expectation& expectation) {
  if (session_.facts().Holds(expectation.literal, expectation.text)) return std::nullopt;
  if (IsDisturbed(expectation)) return std::nullopt;
  const std::string key = TextOf(expectation);
  const auto known = broken_.find(key);
  const double since = known == broken_.end() ? session_.now() : known->second;
  still_broken_[key] = since;
  return since;
}

/// What a running step rests on, but for what it changes itself.
void StepWatch::CheckConditions(int index) {
  const StepRun& step = session_.run().at(index);
  for (const Expectation& expectation : step.expectations) {
    const std::optional<double> since = BrokenSince(expectation);
    if (!since || !IsPast(*since + session_.params().break_delay)) continue;
    session_.Stop(index);
    session_.Report(
        {Trouble::Kind::kPrecondition, step.action, "condition_lost: " + TextOf(expectation)},
        step.activity);
    return;
  }
}

/// What a later step rests on and was there already.
void StepWatch::CheckLinks(int index) {
  const PlanRun& run = session_.run();
  const StepRun& step = run.at(index);
  // A step whose turn has come may have to wait for an observation that is under way.
  const double patience = step.phase == StepPhase::kReady ? session_.params().effect_timeout
                                                          : session_.params().break_delay;
  for (const Expectation& expectation : step.expectations) {
    const bool is_there =
        expectation.producer < 0 || run.at(expectation.producer).phase == StepPhase::kDone;
    const auto since = is_there ? BrokenSince(expectation) : std::nullopt;
    if (!since || !IsPast(*since + patience)) continue;
    if (MayBeOnItsWay(*since + patience, base::ToString(step.action))) continue;
    session_.Report(
        {Trouble::Kind::kPrecondition, step.action, "condition_lost: " + TextOf(expectation)}, 0);
    return;
  }
}

}  // namespace hires::execution
