#include "execution/step_dispatch.h"

#include <algorithm>

namespace hires::execution {
namespace {

/// Whether `disturbed`, which lasts only while a step runs, would break what another rests on.
bool Breaks(const std::vector<Datum>& passing, const StepRun& other) {
  return std::any_of(other.expectations.begin(), other.expectations.end(),
                     [&](const Expectation& expectation) {
                       return CanMatchAny(passing, expectation.literal.atom);
                     });
}

}  // namespace

void StepDispatch::Run() {
  for (bool again = true; again;) {
    again = false;
    for (int i = 0; i < session_.progress().run().size(); ++i) again = Advance(i) || again;
  }
}

bool StepDispatch::Advance(int index) {
  StepRun& step = session_.progress().run().at(index);
  if (step.kind == StepRun::Kind::kImagine || !step.IsWaiting()) return false;
  if (!session_.progress().run().AreDone(step.after)) return false;
  if (step.phase == StepPhase::kWaiting) {
    step.phase = StepPhase::kReady;
    step.ready = session_.now();
  }
  if (step.kind == StepRun::Kind::kBookkeeping) {
    if (!Holds(step)) return false;
    session_.progress().Pass(index);
    session_.state().Note(session_.progress().run().planned(index));
    return true;
  }
  if (CanRun(index) && desk_.MayStart(index)) Start(index);
  return false;
}

/// Whether what it rests on is observed.
bool StepDispatch::Holds(const StepRun& step) const {
  return std::all_of(step.expectations.begin(), step.expectations.end(),
                     [&](const Expectation& expectation) {
                       return session_.state().facts().Holds(expectation.literal, expectation.text);
                     });
}

bool StepDispatch::CanRun(int index) const {
  return Holds(session_.progress().run().at(index)) && HasResources(index) && IsUndisturbed(index);
}

bool StepDispatch::HasResources(int index) const {
  const PlanRun& run = session_.progress().run();
  std::map<std::string, int> used = run.at(index).resources;
  for (const int active : run.Active()) {
    if (run.at(active).phase != StepPhase::kRunning) continue;
    for (const auto& [resource, units] : run.at(active).resources) used[resource] += units;
  }
  const auto& capacities = session_.operators().capacities;
  return std::all_of(used.begin(), used.end(),
                     [&](const auto& entry) { return entry.second <= capacities.at(entry.first); });
}

bool StepDispatch::IsUndisturbed(int index) const {
  const PlanRun& run = session_.progress().run();
  const StepRun& step = run.at(index);
  for (const int active : run.Active()) {
    const StepRun& other = run.at(active);
    if (Breaks(other.disturbance.passing, step) || Breaks(step.disturbance.passing, other)) {
      return false;
    }
  }
  return true;
}

void StepDispatch::Start(int index) {
  desk_.Settle(index);
  if (!CanRun(index)) return;  // with other arguments it may need something else
  const MonitorParams& params = session_.params();
  const double expected = session_.progress().network().Expected(index);
  const double limit = std::max(params.overdue_minimum, params.overdue_factor * expected);
  session_.progress().Start(index, limit, session_.state().facts());
}

}  // namespace hires::execution
