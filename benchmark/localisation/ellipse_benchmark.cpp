// How often does the ellipse that the filter calls 95 % sure hold the truth? Counters are over all
// drives of a line, with `boxes` things that the map lacks; see docs/notes_navigation.md.
#include <benchmark/benchmark.h>

#include <cmath>

#include "hires/geometry/angles.h"
#include "hires/localisation/monte_carlo.h"
#include "rooms.h"
#include "support/simulated_drive.h"

namespace hires::localisation {
namespace {

using localisation_benchmarks::Room;
using localisation_benchmarks::RoomsToChooseIn;
using localisation_benchmarks::RoomsToJudgeIn;
using test_support::SimulatedDrive;
using world::OccupancyGrid;

struct Count {
  double squares{0.0}, worst{0.0};  // [m^2], [m]
  int scans{0}, used{0}, good{0}, inside{0};
};

/// Follows a drive from where it began; the first 20 scans are not judged, and only what is called
/// good is.
void Follow(const SimulatedDrive& drive, MonteCarloLocalisation filter, Count* count) {
  constexpr double kChiSquared95 = 5.991;  // of 2 degrees of freedom
  std::size_t i = 0;
  for (const RobotLog::Odometry& odometry : drive.log.odometry) {
    if (i >= drive.log.scans.size() || odometry.time != drive.log.scans[i].time) continue;
    const RobotLog::Scan& scan = drive.log.scans[i];
    const ScanOutcome outcome =
        filter.Update(scan.time, odometry.reading.X_OB, scan.reading, scan.X_BL);
    const Eigen::Vector2d truth = drive.truth[i].X_MB.position();
    if (++i <= 20) continue;
    const PoseEstimate estimate = filter.Estimate(scan.time);
    const Eigen::Vector2d off = estimate.X_MB.position() - truth;
    count->squares += off.squaredNorm();
    count->worst = std::max(count->worst, off.norm());
    ++count->scans;
    if (outcome != ScanOutcome::kUpdated) continue;
    ++count->used;
    if (estimate.status != LocalisationStatus::kGood) continue;
    ++count->good;
    const Eigen::Matrix2d P = estimate.covariance.topLeftCorner<2, 2>();
    count->inside += off.dot(P.inverse() * off) <= kChiSquared95;
  }
}

void BM_Ellipse(benchmark::State& state) {
  const bool is_judging = state.range(0) == 1;
  const std::vector<Room> rooms = is_judging ? RoomsToJudgeIn() : RoomsToChooseIn();
  if (rooms.empty()) {
    state.SkipWithError("the original maps are not there");
    return;
  }
  const int first = is_judging ? 1701 : 301, num_seeds = is_judging ? 8 : 12;
  Count count;
  for (auto _ : state) {
    for (const Room& room : rooms) {
      for (int seed = first; seed < first + num_seeds; ++seed) {
        const OccupancyGrid world = test_support::WithBoxes(
            room.grid, room.course, static_cast<int>(state.range(1)), base::Rng(seed).Fork(1));
        const SimulatedDrive drive =
            test_support::DriveThrough(world, room.course, {}, base::Rng(seed));
        MonteCarloParams params;
        params.initial_pose = drive.truth.front().X_MB;
        params.independent_beams = static_cast<double>(state.range(2));
        Follow(drive, MonteCarloLocalisation(room.grid, params, base::Rng(seed).Fork(2)), &count);
      }
    }
  }
  state.counters["inside_percent"] = 100.0 * count.inside / count.good;
  state.counters["good_percent"] = 100.0 * count.good / count.used;
  state.counters["updates"] = count.used;
  state.counters["rms_mm"] = 1000.0 * std::sqrt(count.squares / count.scans);
  state.counters["worst_mm"] = 1000.0 * count.worst;
}
BENCHMARK(BM_Ellipse)
    ->ArgNames({"judge", "boxes", "beams"})
    ->ArgsProduct({{0}, {0, 12}, {5, 7, 10, 15, 20, 60}})
    ->ArgsProduct({{1}, {0, 15, 40}, {7, 10, 15, 60}})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hires::localisation
