// In how many of 40 drives is a robot found that may be anywhere in rooms that look alike, without
// and with a shelf? See docs/notes_navigation.md.
#include <benchmark/benchmark.h>

#include <algorithm>

#include "hires/localisation/localise_log.h"
#include "support/simulated_drive.h"

namespace hires::localisation {
namespace {

/// [m] the farthest that a trajectory is from the truth; its poses are of scans of the drive.
double WorstOf(const TimedPath& path, const TimedPath& truth) {
  double worst = 0.0;
  auto at = truth.begin();
  for (const TimedPose& pose : path) {
    while (at->time < pose.time) ++at;
    worst = std::max(worst, (pose.X_MB.position() - at->X_MB.position()).norm());
  }
  return worst;
}

void BM_Global(benchmark::State& state) {
  const world::OccupancyGrid grid =
      state.range(0) == 1 ? test_support::RoomsWithShelf() : test_support::TwoRooms();
  int right = 0, wrong = 0, not_good = 0, whole = 0, told = 0;
  double worst = 0.0;  // [m] of those that are right from begin to end
  for (auto _ : state) {
    for (int seed = 801; seed <= 840; ++seed) {
      const test_support::SimulatedDrive drive = test_support::DriveThrough(
          grid, test_support::CourseThroughTwoRooms(), {}, base::Rng(seed));
      MonteCarloLocalisation filter(grid, {}, base::Rng(seed));
      filter.GlobalLocalisation();
      const LocalisedLog found = LocaliseLog(drive.log, filter, "localising");
      const bool is_good = found.last.status == LocalisationStatus::kGood;
      const double off = (found.last.X_MB.position() - drive.truth.back().X_MB.position()).norm();
      const bool is_right = is_good && off < 0.15;
      right += is_right;
      wrong += is_good && !is_right;
      not_good += !is_good;
      if (!is_right) continue;
      const double farthest = WorstOf(found.path, drive.truth);
      whole += farthest < 1.0;
      told += farthest >= 1.0 && found.num_relocations > 0;
      if (farthest < 1.0) worst = std::max(worst, farthest);
    }
  }
  state.counters["right"] = right;
  state.counters["wrong"] = wrong;
  state.counters["not_good"] = not_good;
  state.counters["whole_path"] = whole;
  state.counters["relocation_told"] = told;
  state.counters["worst_mm"] = 1000.0 * worst;
}
BENCHMARK(BM_Global)->ArgName("shelf")->Arg(0)->Arg(1)->Iterations(1)->Unit(
    benchmark::kMillisecond);

}  // namespace
}  // namespace hires::localisation
