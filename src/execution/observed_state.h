#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "execution/facts.h"
#include "hires/execution/monitor.h"
#include "hires/planning/domain.h"

namespace hires::execution {

/// What was observed of the world, and what bookkeeping steps of the plan made of it.
class ObservedState {
 public:
  explicit ObservedState(const planning::Domain& domain);

  void Observe(const StateObserved& state);
  void ObserveUntil(double time);
  bool is_known() const { return is_known_; }  ///< something was observed
  /// Whether something observed at that time [s] may be on its way here.
  bool IsBehind(double time) const { return observed_until_ && *observed_until_ < time; }
  const Facts& facts() const { return facts_; }
  /// Changes whenever facts do.
  int revision() const { return revision_; }

  /// A bookkeeping step of the plan is done; its effects hold until the task is over.
  void Note(const planning::PlanStep& bookkeeping);
  void ForgetNotes();

  /// Whether an operator of the domain may change it.
  bool IsChanging(const std::string& predicate) const { return changing_.MayHave(predicate); }
  /// Known to imagination: named by an atom or by a change.
  const std::set<std::string>& instances() const { return instances_; }
  void Know(const std::set<std::string>& instances);

 private:
  planning::PredicateSet changing_;
  bool is_known_{false};
  std::optional<double> observed_until_;  // [s]
  Facts observed_, facts_;
  std::vector<planning::PlanStep> bookkeeping_;
  std::set<std::string> instances_;
  int revision_{0};
};

}  // namespace hires::execution
