// What does one update of Monte Carlo localisation with 1000 particles cost, and that of a new map?
#include <benchmark/benchmark.h>

#include "hires/localisation/monte_carlo.h"
#include "support/simulated_drive.h"

namespace hires::localisation {
namespace {

/// 20 m x 20 m with pillars every 2.5 m.
world::OccupancyGrid Hall() {
  world::OccupancyGrid grid{0.05, 400, 400, {0.0, 0.0}, {}};
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      const bool is_border = row < 2 || column < 2 || row >= 398 || column >= 398;
      const bool is_pillar = row % 50 < 6 && column % 50 < 6;
      grid.cells.push_back(is_border || is_pillar ? world::Cell::kOccupied : world::Cell::kFree);
    }
  }
  return grid;
}

void BM_Update(benchmark::State& state) {  // of 30, 60 beams
  const world::OccupancyGrid grid = Hall();
  base::Rng rng(7);
  const test_support::SimulatedDriveParams drive;
  const geometry::Pose2 X_MB{8.9, 8.9, 0.3};
  const robot::ScanReading scan = test_support::ScanInGrid(grid, X_MB * drive.X_BL, drive, &rng);
  MonteCarloParams params;
  params.initial_pose = X_MB;
  params.min_particles = params.max_particles = 1000;
  params.laser_max_beams = static_cast<int>(state.range(0));
  params.update_min_d = params.update_min_a = 0.0;
  params.recovery_alpha_slow = params.recovery_alpha_fast = 0.0;
  MonteCarloLocalisation filter(grid, params, base::Rng(7));
  double time = 0.0;
  for (int i = 0; i < 50; ++i) filter.Update(time += 0.1, {}, scan, drive.X_BL);  // settle
  for (auto _ : state) filter.Update(time += 0.1, {}, scan, drive.X_BL);
  state.counters["particles"] = filter.Estimate(time).num_particles;
}
BENCHMARK(BM_Update)->Arg(30)->Arg(60)->Unit(benchmark::kMicrosecond);

void BM_LikelihoodFieldOfAMap(benchmark::State& state) {  // what a new map costs once
  const world::OccupancyGrid grid = Hall();
  MonteCarloParams params;
  params.max_particles = params.min_particles = 1;
  for (auto _ : state) {
    benchmark::DoNotOptimize(MonteCarloLocalisation(grid, params, base::Rng(7)));
  }
}
BENCHMARK(BM_LikelihoodFieldOfAMap)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hires::localisation
