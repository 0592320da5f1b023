#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "execution/outbox.h"
#include "execution/plan_network.h"
#include "execution/plan_run.h"

namespace hires::execution {

/// The task that is carried out, the plan for it and how far its steps are; each turn is recorded.
class PlanProgress {
 public:
  /// @param outbox  outlives this.  @param arrival_margin  [s] see MonitorParams.
  PlanProgress(Outbox* outbox, double arrival_margin)
      : outbox_(*outbox), arrival_margin_(arrival_margin) {}

  double now() const { return now_; }
  void SetNow(double now);
  /// Changes whenever plan or steps do.
  int revision() const { return revision_; }
  void Changed() { ++revision_; }

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
  /// Of the task's earlier plans, too.
  std::vector<StepStatus> Steps() const;

  /// @param facts  that hold as it begins.
  void Start(int step, double time_limit, const Facts& facts);
  /// No effect where it has been told already.
  void Stop(int step, const base::Failure& why = base::FailureCode::kPreempted);
  /// What a step that has not begun rests on is gone.
  void Blame(int step, const base::Failure& loss);
  /// The step is over as its activity told; `phase` says what now.
  void End(int step, StepPhase phase, const std::string& result, const base::Failure& failure);
  void Pass(int step);     ///< a step that is no action of the robot: done at once
  void Confirm(int step);  ///< its effects have been seen

 private:
  void LeavePlan(const std::vector<std::pair<int, int>>& taken_over);
  void PlaceInTime(const std::vector<std::pair<int, int>>& taken_over);
  void RecordPlan();
  StepStatus StatusOf(int index) const;

  Outbox& outbox_;
  const double arrival_margin_;
  double now_{0.0};  // [s]
  int revision_{0};
  int last_activity_{0}, last_plan_{0}, first_plan_{0};
  std::string task_;
  std::optional<PlanRun> run_;
  std::optional<PlanNetwork> network_;
  std::vector<int> informs_;
  std::vector<StepStatus> past_;
};

}  // namespace hires::execution
