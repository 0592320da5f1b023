#include "execution/exclusions.h"

#include <algorithm>
#include <utility>

#include "execution/records.h"

namespace hires::execution {

Exclusion ExclusionFor(const base::ActionCall& action, const base::Failure& failure) {
  return {action, failure, {failure.subjects.begin(), failure.subjects.end()}, 0};
}

void Exclusions::Add(Exclusion exclusion, int plan, int step) {
  for (const Exclusion& known : exclusions_) {
    if (known.action == exclusion.action) return;
  }
  exclusion.record = outbox_.NewRecord();
  outbox_.Send(FailureImagined(exclusion.record, plan, step, exclusion.action, exclusion.failure));
  exclusions_.push_back(std::move(exclusion));
}

void Exclusions::Forget(const std::set<std::string>& changed, const std::set<std::string>& known) {
  const auto rests_on = [&](const Exclusion& exclusion) {
    return std::any_of(changed.begin(), changed.end(), [&](const std::string& instance) {
      // What is seen for the first time was in the way before it had a pose.
      return exclusion.depends_on.count(instance) > 0 && known.count(instance) > 0;
    });
  };
  for (auto exclusion = exclusions_.begin(); exclusion != exclusions_.end();) {
    if (!rests_on(*exclusion)) {
      ++exclusion;
      continue;
    }
    outbox_.Send(FailureForgotten(exclusion->record, exclusion->action));
    exclusion = exclusions_.erase(exclusion);
  }
}

void Exclusions::Clear() {
  for (const Exclusion& exclusion : exclusions_) {
    outbox_.Send(FailureForgotten(exclusion.record, exclusion.action));
  }
  exclusions_.clear();
}

std::vector<base::Atom> Exclusions::Atoms() const {
  std::vector<base::Atom> atoms;
  for (const Exclusion& exclusion : exclusions_) {
    atoms.push_back({"imagined_failure", {exclusion.action.name}});
    const auto& arguments = exclusion.action.arguments;
    atoms.back().arguments.insert(atoms.back().arguments.end(), arguments.begin(), arguments.end());
  }
  return atoms;
}

}  // namespace hires::execution
