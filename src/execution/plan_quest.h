#pragma once

#include <optional>
#include <string>
#include <vector>

#include "execution/session.h"

namespace hires::execution {

/// Asks the planner, for one network of tasks after the other until there is a plan.
class PlanQuest {
 public:
  /// A problem, and its tasks as text.
  struct Try {
    planning::Problem problem;
    std::string tasks;
  };
  enum class Outcome {
    kAsking,
    kFound,
    kNoPlan,  ///< the last try, which may change all, saw all there is
    kFailed,  ///< there is no planner, it met a limit, or it does not understand
  };

  explicit PlanQuest(Session* session) : session_(*session) {}

  /// @param state  Facts that hold; those that exclude steps come from the session.
  /// @pre there is a try.
  void Begin(std::vector<Try> tries, const Facts& state);
  void Cancel();
  void OnAnswer(const PlanArrived& answer);
  void Update();  ///< looks at the clock
  std::optional<double> WakeAt() const;

  bool is_under_way() const { return is_under_way_; }
  Outcome outcome() const { return outcome_; }
  const std::string& why() const { return why_; }
  /// @pre kFound
  const planning::Plan& plan() const { return plan_; }
  const planning::Problem& problem() const { return tries_[at_].problem; }

 private:
  void Ask();
  void Next(const PlanArrived& answer);
  void End(Outcome outcome, const std::string& why);

  Session& session_;
  std::vector<Try> tries_;
  std::vector<base::Atom> state_;
  std::size_t at_{0};
  bool is_under_way_{false};
  Outcome outcome_{Outcome::kNoPlan};
  std::string why_;
  planning::Plan plan_;
  int request_{0};  ///< out with the planner; 0: none
  double asked_{0.0};
  std::optional<double> retry_;        ///< [s]
  std::optional<double> unavailable_;  ///< since [s]
  bool was_slow_{false};
};

}  // namespace hires::execution
