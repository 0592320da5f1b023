#pragma once

#include <functional>
#include <map>

#include "hires/execution/monitor.h"
#include "loop/virtual_clock.h"

namespace hires::loop {

/// Plans for the execution monitor. A search takes `duration` of virtual time, whatever it takes.
class PlanningDesk {
 public:
  using OnAnswer = std::function<void(const execution::PlanArrived&)>;

  /// @param duration  [s]  @pre knowledge and clock outlive this.
  PlanningDesk(const planning::PlanningKnowledge& knowledge, double duration, VirtualClock* clock,
               OnAnswer on_answer);

  void Start(const execution::StartPlanning& command);
  void Cancel(const execution::CancelPlanning& command) { awaited_.erase(command.request); }
  void CancelAll() { awaited_.clear(); }

 private:
  execution::PlanArrived Search(const execution::StartPlanning& command) const;

  const planning::PlanningKnowledge& knowledge_;
  const double duration_;
  VirtualClock& clock_;
  const OnAnswer on_answer_;
  std::map<int, int> awaited_;  // request -> number of its search
  int num_searches_{0};
};

}  // namespace hires::loop
