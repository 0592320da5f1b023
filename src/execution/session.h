#pragma once

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "execution/plan_network.h"
#include "execution/plan_run.h"
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

/// An action that the planner shall not use (imagined_failure action arguments...).
struct Exclusion {
  base::ActionCall action;
  base::Failure failure;             ///< that is expected of it
  std::set<std::string> depends_on;  ///< instances; when one changes, it is forgotten
  int record{0};                     ///< number of its record
};

/// One that rests on what the failure is about.
Exclusion ExclusionFor(const base::ActionCall& action, const base::Failure& failure);

/// What the parts of the monitor share while a task is carried out: the state, the plan with its
/// network, and the commands that go out with the next answer.
class Session {
 public:
  Session(const planning::PlanningKnowledge* knowledge, const planning::OperatorData* operators,
          const MonitorParams& params);

  const planning::Domain& domain() const { return knowledge_->domain; }
  const planning::OperatorData& operators() const { return *operators_; }
  const MonitorParams& params() const { return params_; }

  // The state.
  double now() const { return now_; }
  void SetNow(double now);
  void Observe(const StateObserved& state);
  void ObserveUntil(double time);
  /// Whether something observed at that time [s] may be on its way here.
  bool IsBehind(double time) const { return observed_until_ && *observed_until_ < time; }
  bool has_state() const { return has_state_; }
  /// What was observed, and what bookkeeping steps made of it.
  const Facts& facts() const { return facts_; }
  /// Changes whenever facts or the plan do.
  int revision() const { return revision_; }
  void Note(const planning::PlanStep& bookkeeping);
  bool IsChanging(const std::string& predicate) const { return changing_.count(predicate) > 0; }
  /// Known to imagination: named by an atom or by a change.
  std::set<std::string>& instances() { return instances_; }

  // The commands.
  template <typename C>
  void Send(C command) {
    commands_.emplace_back(std::move(command));
  }
  void Warning(std::string text) { Send(Warn{std::move(text)}); }
  std::vector<Command> TakeCommands() { return std::exchange(commands_, {}); }
  int NewRequest() { return ++last_request_; }
  int NewRecord() { return ++last_record_; }

  // The plan.
  void BeginTask(const std::string& task);
  void EndTask();  ///< @pre no step is active
  const std::string& task() const { return task_; }
  /// Goes over to a plan. `taken_over`: (step of the new plan, running step of the old one) that
  /// are the same.
  void Adopt(PlanRun run, std::vector<int> informs,
             const std::vector<std::pair<int, int>>& taken_over);
  bool has_plan() const { return run_.has_value(); }
  PlanRun& run() { return *run_; }
  const PlanRun& run() const { return *run_; }
  PlanNetwork& network() { return *network_; }
  const std::vector<int>& informs() const { return informs_; }
  int next_plan() const { return last_plan_ + 1; }
  int plan_index() const { return run_->number() - first_plan_; }  ///< StepStatus::plan
  std::vector<StepStatus> Steps() const;

  // Its steps.
  void Start(int step, double time_limit);
  /// No effect where it has been told already.
  void Stop(int step, const base::Failure& why = base::FailureCode::kPreempted);
  /// What a step that has not begun rests on is gone.
  void Blame(int step, const base::Failure& loss);
  /// The step is over as its activity told; `phase` says what now.
  void End(int step, StepPhase phase, const std::string& result, const base::Failure& failure);
  void Confirm(int step);  ///< its effects have been seen
  bool IsAnyActive() const;
  void Changed() { ++revision_; }

  // What went wrong.
  void Report(Violation violation, int activity);
  std::optional<Violation> TakeViolation() { return std::exchange(violation_, std::nullopt); }
  bool has_violation() const { return violation_.has_value(); }
  void Exclude(Exclusion exclusion, int step);
  void ForgetExclusions(const std::set<std::string>& changed);
  std::vector<base::Atom> ExclusionAtoms() const;

 private:
  void RecordPlan();
  void RecordEndOfPlan(const std::string& outcome);
  StepStatus StatusOf(int index) const;

  const planning::PlanningKnowledge* knowledge_;
  const planning::OperatorData* operators_;
  MonitorParams params_;
  std::set<std::string> changing_;

  double now_{0.0};
  bool has_state_{false};
  std::optional<double> observed_until_;  // [s]
  Facts observed_, facts_;
  std::vector<planning::PlanStep> bookkeeping_;
  int revision_{0};
  std::set<std::string> instances_;

  std::vector<Command> commands_;
  int last_request_{0}, last_record_{0}, last_activity_{0}, last_plan_{0}, first_plan_{0};

  std::string task_;
  std::optional<PlanRun> run_;
  std::optional<PlanNetwork> network_;
  std::vector<int> informs_;
  std::vector<StepStatus> past_;
  std::optional<Violation> violation_;
  std::vector<Exclusion> exclusions_;
};

}  // namespace hires::execution
