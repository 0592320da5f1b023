// What does one control cycle cost, over all cycles of a whole drive?
#include <benchmark/benchmark.h>

#include <algorithm>

#include "hires/base/resource_use.h"
#include "hires/navigation/dwa.h"
#include "navigation/closed_loop.h"

namespace hires::navigation {
namespace {

using namespace test_support;

/// [ms] of processor time that this thread has used; other programs on the machine do not count.
double ThreadMilliseconds() { return 1e3 * base::ThreadCpuSeconds(); }

/// [ms] that each cycle takes when the planner sees the same drive again.
std::vector<double> TimeCycles(DwaPlanner* planner, const Costmap& costmap, const Drive& drive) {
  std::vector<double> milliseconds;
  milliseconds.reserve(drive.cycles.size());
  for (const Cycle& cycle : drive.cycles) {
    const double begin = ThreadMilliseconds();
    benchmark::DoNotOptimize(planner->Update(costmap, cycle.X_MB, cycle.V_B));
    milliseconds.push_back(ThreadMilliseconds() - begin);
  }
  return milliseconds;
}

double Quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * (values.size() - 1))];
}

void Measure(benchmark::State& state, const Scene& scene, const geometry::Pose2& X_MStart,
             const geometry::Pose2& X_MGoal) {
  const robot::MotionSet limits = state.range(0) == 0 ? kSlow : kFast;
  const Costmap costmap = scene.MakeCostmap();
  const PathResult path = PlanPath(costmap, X_MStart, X_MGoal);
  const Drive drive = DriveTo(scene, X_MStart, X_MGoal, limits);
  std::vector<double> milliseconds;
  for (auto _ : state) {
    DwaPlanner planner({}, PaddedFootprint());
    planner.SetMotionSet(limits);
    planner.SetPath(path.path);
    const auto cycles = TimeCycles(&planner, costmap, drive);
    milliseconds.insert(milliseconds.end(), cycles.begin(), cycles.end());
  }
  double samples = 0.0;
  for (const Cycle& cycle : drive.cycles) samples += cycle.result.num_samples;
  state.counters["cycles"] = drive.cycles.size();
  state.counters["samples_per_cycle"] = samples / drive.cycles.size();
  state.counters["median_ms"] = Quantile(milliseconds, 0.5);
  state.counters["p99_ms"] = Quantile(milliseconds, 0.99);
}

void BM_DriveInTheOpen(benchmark::State& state) {
  Measure(state, EmptyScene(14.45, 17.1), {3.0, 8.0, 0.0}, {11.0, 8.0, 0.0});
}
BENCHMARK(BM_DriveInTheOpen)->ArgName("fast")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void BM_DriveThroughClutter(benchmark::State& state) {
  Scene scene = EmptyScene(14.45, 17.1);
  for (int i = 0; i < 6; ++i) {
    scene.Add(4.0 + i, i % 2 == 0 ? 8.2 : 6.6, 4.4 + i, i % 2 == 0 ? 9.4 : 7.6);
  }
  Measure(state, scene, {3.0, 8.0, 0.0}, {11.0, 8.0, 0.0});
}
BENCHMARK(BM_DriveThroughClutter)->ArgName("fast")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hires::navigation
