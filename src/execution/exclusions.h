#pragma once

#include <set>
#include <string>
#include <vector>

#include "execution/outbox.h"

namespace hires::execution {

/// An action that the planner shall not use (imagined_failure action arguments...).
struct Exclusion {
  base::ActionCall action;
  base::Failure failure;             ///< that is expected of it
  std::set<std::string> depends_on;  ///< instances; when one changes, it is forgotten
  int record{0};                     ///< number of its record
};

/// One that rests on what the failure is about.
Exclusion ExclusionFor(const base::ActionCall& action, const base::Failure& failure);

/// Those of the task that is carried out; each is recorded when it comes and when it goes.
class Exclusions {
 public:
  /// @param outbox  outlives this.
  explicit Exclusions(Outbox* outbox) : outbox_(*outbox) {}

  /// Nothing happens where the action is excluded already.
  /// @param plan, step  for which it was considered.
  void Add(Exclusion exclusion, int plan, int step);
  /// Those that rest on one of these are over. @param known  instances that had been known before.
  void Forget(const std::set<std::string>& changed, const std::set<std::string>& known);
  void Clear();
  /// As the planner gets them.
  std::vector<base::Atom> Atoms() const;

 private:
  Outbox& outbox_;
  std::vector<Exclusion> exclusions_;
};

}  // namespace hires::execution
