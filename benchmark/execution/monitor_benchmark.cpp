#include <benchmark/benchmark.h>

#include <algorithm>
#include <string>
#include <vector>

#include "support/scripted_world.h"

// How long does the monitor take from an event to the commands that follow from it? A table with n
// mugs is cleared in a scripted world, 17 steps for each; every event of the run counts, plans that
// arrive included.

namespace hires::execution {
namespace {

using test_support::FactsOf;
using test_support::ScriptedWorld;

ScriptedWorld::Options TableWith(int num_mugs) {
  ScriptedWorld::Options options;
  for (const base::Atom& atom : FactsOf("clear_table")) {
    if (atom.predicate != "on" && atom.predicate != "type") options.facts.push_back(atom);
  }
  for (int i = 1; i <= num_mugs; ++i) {
    const std::string mug = "mug" + std::to_string(i);
    const bool is_even = i % 2 == 0;
    options.facts.push_back({"type", {"mug", mug}});
    options.facts.push_back(
        {"on", {mug, is_even ? "placingareawestrighttable1" : "placingareaeastrighttable1"}});
  }
  return options;
}

void BM_HandleEvents(benchmark::State& state) {
  std::vector<double> seconds;
  std::size_t num_steps = 0;
  for (auto _ : state) {
    ScriptedWorld world(TableWith(static_cast<int>(state.range(0))));
    world.Run("clear_table table1 counter1");
    num_steps = world.Begun().size();
    const auto& more = world.handle_seconds();
    seconds.insert(seconds.end(), more.begin(), more.end());
  }
  std::sort(seconds.begin(), seconds.end());
  const auto quantile = [&](double share) {
    return 1e3 * seconds[static_cast<std::size_t>(share * static_cast<double>(seconds.size() - 1))];
  };
  state.counters["steps"] = static_cast<double>(num_steps);
  state.counters["median_ms"] = quantile(0.5);
  state.counters["p99_ms"] = quantile(0.99);
  state.counters["max_ms"] = quantile(1.0);
}
BENCHMARK(BM_HandleEvents)->Arg(1)->Arg(12)->Iterations(10)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hires::execution
