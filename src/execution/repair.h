#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "execution/imagination_desk.h"
#include "execution/plan_quest.h"
#include "execution/session.h"

namespace hires::execution {

/// Mends a plan: waits until no step is being stopped or checked, plans what is left of the task
/// from there, the cheapest change first, and goes over to the plan found. Steps that run go on if
/// the new plan begins with them; else they are stopped, and it is planned again.
class Repair {
 public:
  enum class Result {
    kUnderWay,
    kMended,
    kNoPlan,
    kFailed,  ///< the planner cannot tell, or it is of no use
  };

  Repair(Session* session, PlanQuest* quest) : session_(*session), quest_(*quest) {}

  void BeginTask(const planning::Problem& task);  ///< forgets what was repaired for the last one
  /// @return why it is of no use; "" if it was begun.
  std::string Begin(const Violation& violation);
  void Cancel();
  /// Goes on with a repair; something else may have gone wrong meanwhile.
  Result Update();
  const std::string& why() const { return why_; }
  /// What the last repair was for.  @pre there was one.
  const base::Failure& failure() const { return last_->failure; }
  int count() const { return count_; }

 private:
  bool IsRepetition(const Violation& violation, const std::set<std::string>& state) const;
  bool IsSettled() const;
  void Ask();
  Result Take();
  std::vector<PlanQuest::Try> Tries(const Facts& state) const;
  /// (step of the plan, running step) pairs; nothing where a running one is not wanted.
  std::vector<std::pair<int, int>> Match(PlanRun* plan, std::vector<int>* unwanted) const;
  bool IsWanted(PlanRun* plan, int step, int running) const;

  Session& session_;
  PlanQuest& quest_;
  planning::Problem task_;
  bool is_asking_{false};
  std::vector<int> assumed_;  ///< steps that were taken back in the state that was planned from
  int count_{0};
  std::string why_;
  std::optional<Violation> last_;  ///< violation
  std::set<std::string> last_state_;
};

}  // namespace hires::execution
