#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/knowledge/pose_watch.h"
#include "loop/loop_parts.h"
#include "loop/planning_desk.h"
#include "loop/record_keeper.h"

namespace hires::loop {

/// The execution monitor with its planner, its imagination and its records, for one task.
class MonitorShell {
 public:
  struct Hooks {
    std::function<void(const execution::StartStep&)> start;
    std::function<void(int activity)> stop;
  };

  /// @param order  what is to be done; its task is given.  @pre all outlive this.
  MonitorShell(const LoopSetup::Parts& parts, const LoopOrder& order, VirtualClock* clock,
               Blackboard* blackboard, RolloutPool* pool, Hooks hooks);

  void Begin();
  void OnView();  ///< the Blackboard says something else
  void OnObservedUntil(double time);
  void OnLocalised(const imagination::BelievedPose& believed) {
    imagination_.OnLocalised(believed);
  }
  void OnStepEnded(const execution::StepFinished& finished) { Feed(finished); }
  void Preempt() { Feed(execution::PreemptRequested{}); }

  bool has_begun() const { return has_begun_; }
  bool is_over() const { return finish_.has_value(); }
  std::int64_t episode() const { return records_.episode(); }
  AchieveStatus Status() const;
  AchieveReport Report() const;  ///< @pre is_over()

 private:
  void Feed(const execution::Event& event);
  void AskForWake();
  void CarryOut(const execution::StartPlanning& command) { planning_.Start(command); }
  void CarryOut(const execution::CancelPlanning& command) { planning_.Cancel(command); }
  void CarryOut(const execution::StartStep& command) { hooks_.start(command); }
  void CarryOut(const execution::StopStep& command) { hooks_.stop(command.activity); }
  void CarryOut(const execution::StartImagination& command) { imagination_.Start(command); }
  void CarryOut(const execution::MoveDeadline& command) { imagination_.Move(command); }
  void CarryOut(const execution::CancelImagination& command) { imagination_.Cancel(command); }
  void CarryOut(const execution::Record& command) { records_.Write(command, clock_.now()); }
  void CarryOut(const execution::Warn& command) { warnings_.push_back(command.text); }
  void CarryOut(const execution::Finish& command) { finish_ = command; }

  const std::string task_;
  VirtualClock& clock_;
  Blackboard& blackboard_;
  const Hooks hooks_;
  knowledge::PoseWatch poses_;
  RecordKeeper records_;
  PlanningDesk planning_;
  ImaginationDesk imagination_;
  execution::Monitor monitor_;
  bool has_begun_{false};
  std::vector<base::Atom> atoms_;
  std::optional<double> observed_until_;  // [s]
  std::vector<std::string> warnings_;
  std::optional<execution::Finish> finish_;
};

}  // namespace hires::loop
