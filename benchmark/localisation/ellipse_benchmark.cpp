// How often does the ellipse that the filter calls 95 % sure hold the truth? Counters are over all
// drives of a line, with `boxes` things that the map lacks; see docs/notes_navigation.md.
#include <benchmark/benchmark.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "hires/geometry/angles.h"
#include "hires/localisation/monte_carlo.h"
#include "support/simulated_drive.h"

namespace hires::localisation {
namespace {

using test_support::SimulatedDrive;
using world::Cell;
using world::OccupancyGrid;

struct Room {
  OccupancyGrid grid;
  std::vector<Eigen::Vector2d> course;
};

/// 10 m x 10 m without a corner, with a table.
OccupancyGrid RoomWithoutCorner() {
  OccupancyGrid grid{0.05, 200, 200, {-3.0, -2.0}, {}};
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      const bool is_border = row < 2 || column < 2 || row >= 198 || column >= 198;
      const bool is_corner = column >= 90 && row >= 100;
      const bool is_table = column >= 40 && column < 56 && row >= 50 && row < 62;
      grid.cells.push_back(is_border || is_corner || is_table ? Cell::kOccupied : Cell::kFree);
    }
  }
  return grid;
}

/// `independent_beams` was chosen here.
std::vector<Room> RoomsToChooseIn() {
  return {{test_support::TwoRooms(), test_support::CourseThroughTwoRooms()},
          {RoomWithoutCorner(),
           {{-2.0, -1.0},
            {5.5, -1.0},
            {5.5, 1.8},
            {-1.5, 2.2},
            {0.5, 4.0},
            {0.5, 6.8},
            {-2.0, 6.8},
            {-2.0, -1.0}}}};
}

/// None where the original maps are not there.
std::vector<Room> RoomsToJudgeIn() {
  std::vector<Room> rooms;
  for (const test_support::Course& course : test_support::OriginalCourses()) {
    const std::string file = std::string(HIRES_SOURCE_DIR) + "/../shared/data/" + course.map;
    if (std::filesystem::exists(file)) rooms.push_back({world::LoadMap(file), course.places});
  }
  return rooms;
}

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
