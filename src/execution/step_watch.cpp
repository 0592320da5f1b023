#include "execution/step_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "hires/base/text.h"

namespace hires::execution {
namespace {

/// Nothing where it succeeded.
base::Failure FailureOf(const StepFinished& finished) {
  using Code = base::FailureCode;
  switch (finished.result) {
    case StepFinished::Result::kSucceeded:
      return {};
    case StepFinished::Result::kFailed:
      return finished.failure ? finished.failure : Code::kOther;
    case StepFinished::Result::kPreempted:
      return Code::kPreempted;
    case StepFinished::Result::kUnavailable:
      return {Code::kUnavailable, {}, finished.failure.detail};
  }
  return Code::kOther;
}

/// It will fail again however often it is tried from here, and another way may do.
bool NeedsAnotherWay(const base::Failure& failure) {
  const base::FailureInfo& info = base::InfoOf(failure.code);
  return info.scope == base::FailureScope::kAction && !info.may_pass;
}

base::Failure About(base::FailureCode code, const base::Atom& atom, const std::string& text) {
  return {code, atom.arguments, text};
}

std::string TextOf(const Expectation& expectation) {
  const std::string atom = base::ToString(AtomOf(expectation.literal.atom));
  return expectation.literal.holds ? atom : "not " + atom;
}

base::Failure LossOf(const Expectation& expectation) {
  return About(base::FailureCode::kConditionLost, AtomOf(expectation.literal.atom),
               TextOf(expectation));
}

}  // namespace

void StepWatch::OnFinished(const StepFinished& finished) {
  const int index = session_.progress().has_plan()
                        ? session_.progress().run().FindActivity(finished.activity)
                        : -1;
  if (index < 0) return;  // of a step that is over or was given up
  const base::Failure failure = FailureOf(finished);
  if (!failure) return session_.progress().End(index, StepPhase::kChecking, "succeeded", {});
  const StepRun& step = session_.progress().run().at(index);
  if (step.is_stopping) {
    return session_.progress().End(index, StepPhase::kFailed, "preempted", step.stop_reason);
  }
  session_.progress().End(index, StepPhase::kFailed, "failed", failure);
  if (NeedsAnotherWay(failure)) session_.Exclude(ExclusionFor(step.action, failure), index);
  session_.Report({Violation::Kind::kActivity, step.action, failure, index}, step.activity);
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
  PlanRun& run = session_.progress().run();
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

/// What such a step still does is unknown: nothing may begin beside it.
void StepWatch::CheckStop(int index) {
  const StepRun& step = session_.progress().run().at(index);
  if (!IsPast(*step.stopped + session_.params().stop_timeout)) return;
  lost_ = fmt::format("{} was told to stop and has not answered for {} s",
                      base::ToString(step.action), session_.params().stop_timeout);
  session_.outbox().Warning(lost_ + "; the robot may still move");
  session_.progress().End(index, StepPhase::kFailed, "failed", base::FailureCode::kDidNotStop);
}

void StepWatch::CheckDuration(int index) {
  const StepRun& step = session_.progress().run().at(index);
  if (!IsPast(*step.started + step.time_limit)) return;
  const base::Failure overdue = base::FailureCode::kTimedOut;
  session_.progress().Stop(index, overdue);
  session_.Report({Violation::Kind::kTimeout, step.action, overdue}, step.activity);
}

std::optional<base::Failure> StepWatch::MissingEffect(int index) const {
  constexpr base::FailureCode kCode = base::FailureCode::kEffectMissing;
  const planning::PlanStep& planned = session_.progress().run().planned(index);
  for (const Datum& atom : planned.adds) {
    if (session_.state().facts().HoldsText(ToString(atom))) continue;
    return About(kCode, AtomOf(atom), base::ToString(AtomOf(atom)));
  }
  for (const Datum& atom : planned.deletes) {
    if (!session_.state().facts().HoldsText(ToString(atom))) continue;
    return About(kCode, AtomOf(atom), "not " + base::ToString(AtomOf(atom)));
  }
  return std::nullopt;
}

void StepWatch::CheckEffects(int index) {
  std::optional<base::Failure> missing = MissingEffect(index);
  if (!missing) return session_.progress().Confirm(index);
  StepRun& step = session_.progress().run().at(index);
  const double due = *step.finished + session_.params().effect_timeout;
  if (!IsPast(due) || MayBeOnItsWay(due, base::ToString(step.action))) return;
  if (session_.state().IsBehind(due)) missing->code = base::FailureCode::kEffectUnknown;
  step.phase = StepPhase::kFailed;
  step.note = ToString(*missing);
  step.failure = *missing;
  session_.progress().Changed();
  session_.Report({Violation::Kind::kEffect, step.action, *missing}, step.activity);
}

/// An effect that was not reported yet may still hold, for a limited time.
bool StepWatch::MayBeOnItsWay(double due, const std::string& action) {
  if (!session_.state().IsBehind(due)) {
    late_.erase(action);
    return false;
  }
  const MonitorParams& params = session_.params();
  // Word of what is observed always takes a moment: it is worth telling where it takes long.
  if (IsPast(due + params.effect_timeout) && late_.insert(action).second) {
    session_.outbox().Warning(
        fmt::format("{}: word of what is observed is {:.1f} s late; it is waited for up to {} s",
                    action, params.effect_timeout, params.observation_delay));
  }
  return !IsPast(due + params.observation_delay);
}

/// Whether a running step may have changed it for a while.
bool StepWatch::IsDisturbed(const Expectation& expectation) const {
  const PlanRun& run = session_.progress().run();
  for (const int step : run.Active()) {
    if (run.at(step).disturbance.Touches(expectation.literal.atom)) return true;
  }
  return false;
}

/// Since when it does not hold [s], undisturbed.
std::optional<double> StepWatch::BrokenSince(const Expectation& expectation) {
  if (session_.state().facts().Holds(expectation.literal, expectation.text)) return std::nullopt;
  if (IsDisturbed(expectation)) return std::nullopt;
  const std::string key = TextOf(expectation);
  const auto known = broken_.find(key);
  const double since = known == broken_.end() ? session_.now() : known->second;
  still_broken_[key] = since;
  return since;
}

/// What a running step rests on, but for what it changes itself.
void StepWatch::CheckConditions(int index) {
  const StepRun& step = session_.progress().run().at(index);
  for (const Expectation& expectation : step.expectations) {
    const std::optional<double> since = BrokenSince(expectation);
    if (!since || !IsPast(*since + session_.params().break_delay)) continue;
    const base::Failure loss = LossOf(expectation);
    session_.progress().Stop(index, loss);
    session_.Report({Violation::Kind::kPrecondition, step.action, loss}, step.activity);
    return;
  }
}

/// What a later step rests on and was there already.
void StepWatch::CheckLinks(int index) {
  const PlanRun& run = session_.progress().run();
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
    const base::Failure loss = LossOf(expectation);
    session_.progress().Blame(index, loss);
    session_.Report({Violation::Kind::kPrecondition, step.action, loss}, 0);
    return;
  }
}

}  // namespace hires::execution
