#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/temporal/stn.h"

// How long does one change of a network take to be known everywhere? A plan of n steps: 2 n points,
// each step lasts, follows the one before it, and one or two others at random, and nothing begins
// before now: some 5 n constraints.

namespace hires::temporal {
namespace {

struct PlanNetwork {
  Stn network;
  std::vector<Stn::Point> starts, finishes;
};

PlanNetwork Build(int num_steps) {
  base::Rng rng(7);
  PlanNetwork plan;
  for (int i = 0; i < num_steps; ++i) {
    plan.starts.push_back(plan.network.AddPoint("start of " + std::to_string(i)));
    plan.finishes.push_back(plan.network.AddPoint("finish of " + std::to_string(i)));
    const double least = rng.Uniform(1.0, 10.0);
    plan.network.Constrain(plan.starts[i], plan.finishes[i], {least, 3.0 * least}, "lasts");
    plan.network.Constrain(Stn::kOrigin, plan.starts[i], {0.0, kForever}, "now");
    if (i == 0) continue;
    plan.network.Constrain(plan.finishes[i - 1], plan.starts[i], {0.0, kForever}, "order");
    for (int link = 0; link < 2; ++link) {
      const int before = rng.Index(i);
      plan.network.Constrain(plan.finishes[before], plan.starts[i], {0.0, kForever}, "link");
    }
  }
  plan.network.Constrain(Stn::kOrigin, plan.finishes.back(), {-kForever, 20.0 * num_steps}, "end");
  return plan;
}

/// The first step lasts longer: everything after it moves. Then back.
void BM_ChangeAtTheBegin(benchmark::State& state) {
  PlanNetwork plan = Build(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    Stn::ConstraintId id = 0;
    plan.network.Constrain(plan.starts[0], plan.finishes[0], {25.0, 26.0}, "late", &id);
    plan.network.Retract(id);
  }
  state.SetItemsProcessed(2 * state.iterations());
}
BENCHMARK(BM_ChangeAtTheBegin)->Arg(20)->Arg(200)->Arg(1000)->Unit(benchmark::kMicrosecond);

/// Any step begins when it begins, as in a running plan.
void BM_StepBegins(benchmark::State& state) {
  PlanNetwork plan = Build(static_cast<int>(state.range(0)));
  base::Rng rng(11);
  for (auto _ : state) {
    const int step = rng.Index(static_cast<int>(plan.starts.size()));
    const double start = plan.network.Of(plan.starts[step]).earliest + 1.0;
    Stn::ConstraintId id = -1;
    plan.network.Constrain(Stn::kOrigin, plan.starts[step], {start, start}, "begun", &id);
    if (id >= 0) plan.network.Retract(id);
  }
  state.SetItemsProcessed(2 * state.iterations());
}
BENCHMARK(BM_StepBegins)->Arg(20)->Arg(200)->Arg(1000)->Unit(benchmark::kMicrosecond);

/// What is refused is searched for, and explained.
void BM_Refused(benchmark::State& state) {
  PlanNetwork plan = Build(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    auto conflict = plan.network.Constrain(Stn::kOrigin, plan.finishes.back(), {0.0, 1.0}, "soon");
    benchmark::DoNotOptimize(conflict);
  }
}
BENCHMARK(BM_Refused)->Arg(20)->Arg(200)->Arg(1000)->Unit(benchmark::kMicrosecond);

void BM_Between(benchmark::State& state) {
  const PlanNetwork plan = Build(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(plan.network.Between(plan.starts.front(), plan.finishes.back()));
  }
}
BENCHMARK(BM_Between)->Arg(20)->Arg(200)->Arg(1000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace hires::temporal
