#include <benchmark/benchmark.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "hires/mapping/map_judge.h"
#include "hires/mapping/mapper.h"
#include "support/simulated_drive.h"

// What does a scan cost, and how far off are trajectory and walls? Counters are of the drive with
// the seed that is the last argument; see docs/notes_navigation.md.
namespace hires::mapping {
namespace {

using test_support::SimulatedDriveParams;

SimulatedDriveParams ParamsOf(int kind) {
  SimulatedDriveParams params;
  if (kind == 1) {  // a short laser
    params.beams = 181;
    params.range_noise = 0.03;
    params.range_max = 8.0;
  } else if (kind == 2) {  // bad odometry
    params.scale_error = 0.05;
    params.veer_error = 0.05;
  } else if (kind == 3) {  // worse
    params.scale_error = 0.1;
    params.veer_error = 0.1;
    params.step_error = 0.3;
  }
  return params;
}

void Map(const world::OccupancyGrid& world, const std::vector<Eigen::Vector2d>& places,
         const SimulatedDriveParams& params, benchmark::State* state) {
  const auto seed = static_cast<std::uint64_t>(state->range(2));
  const test_support::SimulatedDrive drive =
      test_support::DriveThrough(world, places, params, base::Rng(seed));
  MapResult result;
  for (auto _ : *state) result = MakeMap(drive.log);
  const double scans = static_cast<double>(drive.log.scans.size());
  const localisation::PathError path = localisation::ErrorOf(result.trajectory, drive.truth);
  const WallErrors walls =
      JudgeWalls(result.grid, world, path.X_TP,
                 FacesThatWereSeen(world, drive.log.scans, drive.truth, MapperParams{}.max_range));
  state->counters["rms_mm"] = 1000.0 * path.rms;
  state->counters["wall_mm"] = 1000.0 * walls.to_world.median;
  state->counters["wall_most_mm"] = 1000.0 * walls.to_world.most;
  state->counters["seen_mm"] = 1000.0 * walls.to_map.median;
  state->counters["seen_most_mm"] = 1000.0 * walls.to_map.most;
  state->counters["loops"] = result.num_loops;
  state->SetItemsProcessed(static_cast<std::int64_t>(scans * state->iterations()));
}

void BM_Map(benchmark::State& state) {
  const test_support::Course course = test_support::OriginalCourses().at(state.range(0));
  const std::string file = std::string(HIRES_SOURCE_DIR) + "/../shared/data/" + course.map;
  if (!std::filesystem::exists(file)) {
    state.SkipWithError("the original maps are not there");
    return;
  }
  Map(world::LoadMap(file), course.places, ParamsOf(static_cast<int>(state.range(1))), &state);
}
BENCHMARK(BM_Map)
    ->ArgNames({"course", "kind", "seed"})
    ->ArgsProduct({{0, 1}, {0, 1, 2, 3}, {21, 22, 23, 24, 25}})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

void BM_MapRoundABlock(benchmark::State& state) {
  SimulatedDriveParams params = ParamsOf(static_cast<int>(state.range(1)));
  params.beams = 181;
  Map(test_support::CorridorRoundABlock(), test_support::CourseRoundABlock(), params, &state);
}
BENCHMARK(BM_MapRoundABlock)
    ->ArgNames({"course", "kind", "seed"})
    ->ArgsProduct({{2}, {0, 1, 2, 3}, {21, 22, 23, 24, 25}})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hires::mapping
