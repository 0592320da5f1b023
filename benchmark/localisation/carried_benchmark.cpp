// A robot that was carried away without a word: does it notice, is it found again, and how often is
// it sure of a wrong place? And one that was not, among things that the map lacks: how often does
// it take itself to be lost? See docs/notes_navigation.md.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "hires/geometry/covariance.h"
#include "hires/localisation/monte_carlo.h"
#include "rooms.h"
#include "support/simulated_drive.h"

namespace hires::localisation {
namespace {

using localisation_benchmarks::Room;
using test_support::SimulatedDrive;

constexpr double kSure = 0.3;       // [m] standard deviation up to which a robot drives
constexpr double kElsewhere = 0.5;  // [m]

struct Count {
  int drives{0}, noticed{0}, found{0}, deceived{0};
  long scans{0}, lost{0}, wrong_and_sure{0};
  std::vector<double> until_found;  // [s]
};

void Follow(const SimulatedDrive& drive, MonteCarloLocalisation filter, Count* count) {
  bool is_noticed = false, is_wrong = false, is_sure = false;
  double last_wrong = 0.0;
  std::size_t i = 0;
  for (const RobotLog::Odometry& odometry : drive.log.odometry) {
    if (i >= drive.log.scans.size() || odometry.time != drive.log.scans[i].time) continue;
    const RobotLog::Scan& scan = drive.log.scans[i];
    filter.Update(scan.time, odometry.reading.X_OB, scan.reading, scan.X_BL);
    const PoseEstimate estimate = filter.Estimate(scan.time);
    const Eigen::Matrix3d& P = estimate.covariance;
    is_sure = geometry::LargestSd(P(0, 0), P(0, 1), P(1, 1)) <= kSure;
    is_wrong = (estimate.X_MB.position() - drive.truth[i].X_MB.position()).norm() > kElsewhere;
    is_noticed = is_noticed || !is_sure;
    if (is_wrong) last_wrong = scan.time;
    ++count->scans;
    count->lost += !is_sure;
    count->wrong_and_sure += is_wrong && is_sure;
    ++i;
  }
  ++count->drives;
  count->noticed += is_noticed;
  count->found += !is_wrong && is_sure;
  count->deceived += is_wrong && is_sure;
  if (!is_wrong) count->until_found.push_back(last_wrong);
}

/// It stands where its course begins, and turns: by quarters, and 0.02 m aside each time.
std::vector<Eigen::Vector2d> Turning(const Eigen::Vector2d& at) {
  constexpr int kQuarters = 24;
  std::vector<Eigen::Vector2d> places{at};
  for (int i = 0; i < kQuarters; ++i) {
    const double angle = 0.5 * geometry::kPi * i;
    places.push_back(places.back() + 0.02 * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return places;
}

void BM_Carried(benchmark::State& state) {
  const bool is_judging = state.range(0) == 1, is_carried = state.range(1) >= 1;
  const bool turns = state.range(1) == 2;
  const std::vector<Room> rooms = is_judging ? localisation_benchmarks::RoomsToJudgeIn()
                                             : localisation_benchmarks::RoomsToChooseIn();
  if (rooms.empty()) {
    state.SkipWithError("the original maps are not there");
    return;
  }
  const int first = is_judging ? 2701 : 2301, num_seeds = 10;
  Count count;
  for (auto _ : state) {
    for (const Room& room : rooms) {
      for (int seed = first; seed < first + num_seeds; ++seed) {
        const world::OccupancyGrid world = test_support::WithBoxes(
            room.grid, room.course, static_cast<int>(state.range(2)), base::Rng(seed).Fork(1));
        const SimulatedDrive whole =
            test_support::DriveThrough(world, room.course, {}, base::Rng(seed));
        const SimulatedDrive drive =
            turns ? test_support::DriveThrough(
                        world, Turning(room.course[seed % room.course.size()]), {}, base::Rng(seed))
                  : whole;
        MonteCarloParams params;
        params.initial_variance = {1e-3, 1e-3, 4e-4};
        // It takes itself to be at another place of its course, 1 m away at least.
        base::Rng rng = base::Rng(seed).Fork(3);
        const geometry::Pose2& start = drive.truth.front().X_MB;
        params.initial_pose = start;
        while (is_carried && (params.initial_pose.position() - start.position()).norm() < 1.0)
          params.initial_pose = whole.truth[rng.Index(static_cast<int>(whole.truth.size()))].X_MB;
        params.explained_distance = 0.01 * static_cast<double>(state.range(3));
        params.lost_explained = 0.01 * static_cast<double>(state.range(4));
        if (params.lost_explained == 0.0) params.relocate_after = -1.0;
        Follow(drive, MonteCarloLocalisation(room.grid, params, base::Rng(seed).Fork(2)), &count);
      }
    }
  }
  std::sort(count.until_found.begin(), count.until_found.end());
  state.counters["drives"] = count.drives;
  state.counters["noticed"] = count.noticed;
  state.counters["found"] = count.found;
  state.counters["deceived"] = count.deceived;
  if (!count.until_found.empty())
    state.counters["until_found_s"] = count.until_found[count.until_found.size() / 2];
  const double scans = static_cast<double>(count.scans);
  state.counters["lost_percent"] = 100.0 * static_cast<double>(count.lost) / scans;
  state.counters["wrong_and_sure_percent"] =
      100.0 * static_cast<double>(count.wrong_and_sure) / scans;
}
BENCHMARK(BM_Carried)
    ->ArgNames({"judge", "carried", "boxes", "cm", "percent"})
    ->ArgsProduct({{0}, {0, 1, 2}, {12}, {10, 20, 30}, {0, 40, 50, 60, 70}})
    ->ArgsProduct({{1}, {0, 1, 2}, {0, 15, 40}, {20}, {0, 50}})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hires::localisation
