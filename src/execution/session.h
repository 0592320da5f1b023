#pragma once

#include <optional>
#include <string>
#include <utility>

#include "execution/exclusions.h"
#include "execution/observed_state.h"
#include "execution/outbox.h"
#include "execution/plan_progress.h"
#include "hires/execution/monitor.h"

namespace hires::execution {

/// An expectation that broke, so that the plan must be looked at again.
struct Violation {
  enum class Kind { kPrecondition, kEffect, kActivity, kTimeout, kImagined };
  Kind kind{Kind::kActivity};
  base::ActionCall action;  ///< of the step that it is about
  base::Failure failure;
  int step{-1};  ///< its number in the plan, where it was one of the plan's that failed
};
std::string ToString(const Violation& violation);
/// The same went wrong with the same action.
bool IsSame(const Violation& a, const Violation& b);

/// What the parts of the monitor share while a task is carried out.
class Session {
 public:
  Session(const planning::PlanningKnowledge* knowledge, const planning::OperatorData* operators,
          const MonitorParams& params);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  const planning::Domain& domain() const { return knowledge_->domain; }
  const planning::OperatorData& operators() const { return *operators_; }
  const MonitorParams& params() const { return params_; }

  double now() const { return progress_.now(); }
  ObservedState& state() { return state_; }
  PlanProgress& progress() { return progress_; }
  Exclusions& exclusions() { return exclusions_; }
  Outbox& outbox() { return outbox_; }
  const ObservedState& state() const { return state_; }
  const PlanProgress& progress() const { return progress_; }
  /// Changes whenever facts or the plan do.
  int revision() const { return state_.revision() + progress_.revision(); }
  void EndTask();  ///< @pre no step is active

  /// The planner shall not use the action again. @param step  of the plan, for which it was meant.
  void Exclude(Exclusion exclusion, int step);
  // What went wrong; the first is taken up.
  void Report(Violation violation, int activity);
  std::optional<Violation> TakeViolation() { return std::exchange(violation_, std::nullopt); }
  bool has_violation() const { return violation_.has_value(); }

 private:
  const planning::PlanningKnowledge* knowledge_;
  const planning::OperatorData* operators_;
  MonitorParams params_;
  Outbox outbox_;
  ObservedState state_;
  PlanProgress progress_{&outbox_, params_.arrival_margin};
  Exclusions exclusions_{&outbox_};
  std::optional<Violation> violation_;
};

}  // namespace hires::execution
