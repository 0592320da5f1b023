// What does a costmap of the restaurant's size cost, from scratch and with a few things added?
#include <benchmark/benchmark.h>

#include "hires/navigation/costmap.h"
#include "navigation/scenes.h"

namespace hires::navigation {
namespace {

using namespace test_support;

world::OccupancyGrid Cluttered() {
  base::Rng rng(7);
  return RandomGrid(289, 342, 0.01, &rng);
}

void BM_CostmapFromGrid(benchmark::State& state) {
  const world::OccupancyGrid grid = Cluttered();
  for (auto _ : state) benchmark::DoNotOptimize(Costmap(grid, 0.34, {}));
}
BENCHMARK(BM_CostmapFromGrid)->Unit(benchmark::kMicrosecond);

void BM_CostmapWithObstacles(benchmark::State& state) {  // chairs of 0.4 m x 0.4 m
  const Costmap costmap(FreeGrid(289, 342), 0.34, {});
  std::vector<geometry::Polygon> chairs;
  for (int i = 0; i < state.range(0); ++i) {
    chairs.push_back(Rectangle(1.0 + i, 1.0 + i, 1.4 + i, 1.4 + i));
  }
  for (auto _ : state) benchmark::DoNotOptimize(costmap.WithObstacles(chairs));
}
BENCHMARK(BM_CostmapWithObstacles)->Arg(1)->Arg(4)->Unit(benchmark::kMicrosecond);

void BM_FootprintCost(benchmark::State& state) {
  const Costmap costmap(FreeGrid(289, 342), 0.34, {});
  const geometry::Polygon footprint = Pr2Footprint();
  double yaw = 0.0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(costmap.FootprintCost(footprint, {7.0, 8.0, yaw += 0.1}));
  }
}
BENCHMARK(BM_FootprintCost);

}  // namespace
}  // namespace hires::navigation
