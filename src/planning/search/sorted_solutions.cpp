#include "planning/search/sorted_solutions.h"

#include <algorithm>

namespace hires::planning {

bool SortedSolutions::Gather(const CompiledPrecondition& precondition, std::uint32_t variables,
                             std::uint32_t count, SearchPath* path) {
  struct Entry {
    Term key;
    std::size_t first;
  };
  std::vector<Entry> entries;
  std::vector<Term> values;
  Prover& prover = path->prover();
  const std::size_t floor = prover.num_choices();
  prover.HoldPairs(true);
  bool found = prover.Solve(precondition.goals, variables, false);
  for (; found; found = prover.num_choices() > floor && prover.Next(floor)) {
    entries.push_back(
        {path->instances().Evaluate(*precondition.sort_key, variables), values.size()});
    for (std::uint32_t i = 0; i < count; ++i) {
      values.push_back(path->bindings().Resolve(Instantiator::Variable(variables, i)));
    }
  }
  prover.HoldPairs(false);
  if (entries.empty() || prover.interrupted()) return false;
  std::stable_sort(entries.begin(), entries.end(), [&](const Entry& a, const Entry& b) {
    return !precondition.comparison->function(&path->terms(), {a.key, b.key}).IsNil();
  });
  values_.clear();
  for (const Entry& entry : entries) {
    values_.insert(values_.end(), values.begin() + entry.first,
                   values.begin() + entry.first + count);
  }
  num_solutions_ = entries.size();
  next_ = 0;
  variables_ = variables;
  count_ = count;
  return true;
}

void SortedSolutions::Clear() {
  values_.clear();
  num_solutions_ = next_ = 0;
}

void SortedSolutions::BindNext(Bindings* bindings) {
  const Term* values = values_.data() + next_++ * count_;
  for (std::uint32_t i = 0; i < count_; ++i) {
    bindings->Unify(Instantiator::Variable(variables_, i), values[i]);
  }
}

}  // namespace hires::planning
