// What does a path across the restaurant cost?
#include <benchmark/benchmark.h>

#include "hires/navigation/a_star.h"
#include "navigation/scenes.h"

namespace hires::navigation {
namespace {

/// As large as the restaurant's map, with walls that make the path wind.
Costmap WindingMap() {
  world::OccupancyGrid grid = test_support::FreeGrid(289, 342);
  test_support::AddRectangle(&grid, 0.0, 4.0, 11.0, 4.2);
  test_support::AddRectangle(&grid, 3.4, 8.0, 14.4, 8.2);
  test_support::AddRectangle(&grid, 0.0, 12.0, 11.0, 12.2);
  return Costmap(grid, 0.34, {});
}

void BM_PlanPath(benchmark::State& state) {
  const Costmap costmap = WindingMap();
  for (auto _ : state) {
    const PathResult result = PlanPath(costmap, {1.0, 1.0, 0.0}, {1.0, 16.0, 0.0});
    if (result.status != PathStatus::kFound) state.SkipWithError("no path");
    benchmark::DoNotOptimize(result.cost);
  }
}
BENCHMARK(BM_PlanPath)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hires::navigation
