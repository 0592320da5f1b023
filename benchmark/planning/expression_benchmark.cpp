// What does one evaluation of a small test cost, as preconditions do it for every binding?
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "hires/planning/datum_reader.h"
#include "hires/planning/functions.h"
#include "hires/planning/term.h"

namespace hires::planning {
namespace {

/// Any variable: the symbol b1, then 4, by turns of their slots.
class TwoValues : public VariableValues {
 public:
  explicit TwoValues(TermTable* terms) : values_{terms->Symbol("b1"), terms->Integer(4)} {}
  Term Value(int slot) override { return values_[static_cast<std::size_t>(slot)]; }

 private:
  std::vector<Term> values_;
};

void BM_Evaluate(benchmark::State& state, const std::string& text) {
  TermTable terms;
  TwoValues values(&terms);
  const auto slot_of = [](const std::string& name) { return name == "?name" ? 0 : 1; };
  const Expression expression(ReadData(text, "benchmark").front(), slot_of, Functions::Standard(),
                              &terms, "benchmark");
  for (auto _ : state) benchmark::DoNotOptimize(expression.Evaluate(&terms, &values));
  state.SetItemsProcessed(state.iterations());
}

BENCHMARK_CAPTURE(BM_Evaluate, not_eq, "(not (eq '?name '?number))");
BENCHMARK_CAPTURE(BM_Evaluate, more, "(> ?number 3)");
BENCHMARK_CAPTURE(BM_Evaluate, sum, "(+ ?number 1)");
BENCHMARK_CAPTURE(BM_Evaluate, let, "(let ((x (* ?number 2))) (if (< x 5) x 5))");

}  // namespace
}  // namespace hires::planning
