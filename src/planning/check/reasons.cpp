#include "hires/planning/reasons.h"

#include <fmt/format.h>

#include <set>
#include <string>
#include <unordered_map>
#include <utility>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/planning/step_replay.h"

namespace hires::planning {
namespace {

/// Knows which step last made an atom true, and which ones took atoms away.
class Producers {
 public:
  int Of(const Literal& literal) const {
    return literal.holds ? OfPresence(literal.atom) : OfAbsence(literal.atom);
  }

  /// @pre `step` comes after all steps noted before; `facts` are as before the step.
  void Note(int step, const std::vector<Datum>& deletes, const std::vector<Datum>& adds,
            const FactHistory& facts, int moment) {
    for (const Datum& atom : adds) {
      if (!facts.Holds(atom, moment)) added_by_[ToString(atom)] = step;
    }
    for (const Datum& atom : deletes) {
      deleted_[std::string(atom.Head())].push_back({atom, step});
    }
  }

 private:
  int OfPresence(const Datum& atom) const {
    const auto found = added_by_.find(ToString(atom));
    return found == added_by_.end() ? CausalLink::kInitial : found->second;
  }

  int OfAbsence(const Datum& pattern) const {
    const auto found = deleted_.find(std::string(pattern.Head()));
    if (found == deleted_.end()) return CausalLink::kInitial;
    for (auto deletion = found->second.rbegin(); deletion != found->second.rend(); ++deletion) {
      if (Substitution().Unify(pattern, deletion->first)) return deletion->second;
    }
    return CausalLink::kInitial;
  }

  std::unordered_map<std::string, int> added_by_;
  std::unordered_map<std::string, std::vector<std::pair<Datum, int>>> deleted_;  ///< by predicate
};

/// Takes a step of a plan that must be able to go on.
ReplayedStep TakeOrThrow(StepReplay* replay, const PlanStep& step, const std::string& source) {
  const int index = replay->moment();
  ReplayedStep taken = replay->Take(step);
  if (taken.wrong.empty()) return taken;
  throw base::ConfigError(fmt::format("{}step {} {} cannot be taken: {}", At(source, {}), index,
                                      ToString(step.task), base::Join(taken.wrong, "; ")));
}

std::vector<Datum> EachOnce(const std::vector<Datum>& atoms) {
  std::set<std::string> seen;
  std::vector<Datum> result;
  for (const Datum& atom : atoms) {
    if (seen.insert(ToString(atom)).second) result.push_back(atom);
  }
  return result;
}

}  // namespace

void AddReasons(const Domain& domain, const Problem& problem, Plan* plan,
                const Functions& functions) {
  StepReplay replay(domain, problem, functions, true);
  Producers producers;
  for (PlanStep& step : plan->steps) {
    const int index = replay.moment();
    ReplayedStep taken = TakeOrThrow(&replay, step, problem.source);
    step.links.clear();
    for (const Literal& literal : taken.support) {
      step.links.push_back({producers.Of(literal), literal});
    }
    producers.Note(index, taken.deletes, taken.adds, replay.facts(), index);
    step.preconditions = std::move(taken.support);
    step.deletes = std::move(taken.deletes);
    step.adds = std::move(taken.adds);
    step.reads = EachOnce(taken.reads);
  }
  plan->subtask_order.clear();
  if (domain.subtask_order == SubtaskOrder::kKept) {
    plan->subtask_order = OrderOfSubtasks(domain, problem, *plan);
  }
}

std::vector<Datum> FactsAfter(const Domain& domain, const Problem& problem, const Plan& plan,
                              int executed, const Functions& functions) {
  HIRES_CHECK(0 <= executed && executed <= static_cast<int>(plan.steps.size()),
              "the plan has no " + std::to_string(executed) + " steps");
  StepReplay replay(domain, problem, functions, false);
  for (int i = 0; i < executed; ++i) TakeOrThrow(&replay, plan.steps[i], problem.source);
  std::set<std::string> constant;
  for (const Datum& fact : domain.facts) constant.insert(ToString(fact));
  std::vector<Datum> facts;
  for (Datum& fact : replay.facts().FactsAt(executed)) {
    if (constant.count(ToString(fact)) == 0) facts.push_back(std::move(fact));
  }
  return facts;
}

}  // namespace hires::planning
