// How exact and how fast is our Monte Carlo localisation beside MRPT's, the one that its program
// pf-localization runs (CMonteCarloLocalization2D)? Both get the same scans and odometry, use the
// same scans (0.2 m or 0.5 rad after the last one), and begin with the same 1000 particles around
// the true pose; the number stays. A repetition drives once through each room of a set, `boxes`
// things in it that the map lacks; counters are over repetitions. MRPT's random generator is one
// for the whole process, and keeps a drawn number when it is seeded: its results depend a little on
// the lines that ran before.
#include <benchmark/benchmark.h>
#include <mrpt/bayes/CParticleFilter.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/random.h>
#include <mrpt/slam/CMonteCarloLocalization2D.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "hires/base/check.h"
#include "hires/geometry/angles.h"
#include "hires/localisation/monte_carlo.h"
#include "localisation/likelihood_field.h"
#include "rooms.h"
#include "support/simulated_drive.h"

namespace hires::localisation {
namespace {

using geometry::Pose2;
using localisation_benchmarks::Room;
using mrpt::bayes::CParticleFilter;
using mrpt::maps::COccupancyGridMap2D;
using mrpt::obs::CActionRobotMovement2D;
using test_support::SimulatedDrive;

constexpr int kParticles = 1000;
constexpr int kRepetitions = 20;
constexpr int kUnjudgedScans = 20;  // that a drive begins with

/// What a filter did in one repetition.
struct Tally {
  double squares{0.0};  // [m^2] of errors of the position
  double cpu{0.0};      // [s]
  int scans{0}, used{0};

  double rms_mm() const { return 1000.0 * std::sqrt(squares / scans); }
  double ms_per_scan() const { return 1000.0 * cpu / used; }
};

double CpuTime() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }  // [s]

MonteCarloParams OurParams(const Pose2& X_MB) {
  MonteCarloParams params;
  params.min_particles = params.max_particles = kParticles;
  params.initial_pose = X_MB;
  return params;
}

class OurFilter {
 public:
  explicit OurFilter(MonteCarloLocalisation filter) : filter_(std::move(filter)) {}

  /// @return odometry's frame in the map
  Pose2 Use(const RobotLog::Scan& scan, const Pose2& X_OB, double* cpu) {
    const double begin = CpuTime();
    const ScanOutcome outcome = filter_.Update(scan.time, X_OB, scan.reading, scan.X_BL);
    const Pose2 X_MO = filter_.CorrectedOdometry();
    *cpu += CpuTime() - begin;
    HIRES_CHECK(outcome == ScanOutcome::kUpdated, "it uses what is due: " + ToString(outcome));
    return X_MO;
  }

 private:
  MonteCarloLocalisation filter_;
};

/// What can be set in MRPT.
struct MrptSetting {
  CActionRobotMovement2D::TMotionModelOptions motion;
  COccupancyGridMap2D::TLikelihoodOptions likelihood;
  CParticleFilter::TParticleFilterOptions filter;
  bool has_faces{false};  ///< its map has the faces of walls alone, as our likelihood field has
};

enum Kind { kLikeOurs, kItsOwn, kWallFaces };  // of settings, as lines name them

/// kItsOwn is what pf-localization's example localization_demo.ini and the library's motion model
/// say; of its two models this is the Gaussian one, for the samples of the other (mmThrun) keep
/// their weights of 1 in 2.5.8, so that all particles get the first one. The multinomial resampling
/// below half of the particles' effective number is MRPT's default; powFactor is 1.
MrptSetting SettingOf(Kind kind) {
  MrptSetting setting;
  setting.filter.sampleSize = kParticles;
  setting.has_faces = kind == kWallFaces;
  auto& likelihood = setting.likelihood;
  likelihood.likelihoodMethod = COccupancyGridMap2D::lmLikelihoodField_Thrun;
  if (kind == kItsOwn) {
    likelihood.LF_stdHit = 0.4f;
    likelihood.LF_zHit = 0.95f;
    likelihood.LF_zRandom = 0.05f;
    likelihood.LF_maxRange = 80.0f;
    likelihood.LF_maxCorrsDistance = 0.3f;
    likelihood.LF_decimation = 10;
    return setting;
  }
  const MonteCarloParams ours;
  likelihood.LF_stdHit = static_cast<float>(ours.laser_sigma_hit);
  likelihood.LF_zHit = static_cast<float>(ours.laser_z_hit);
  likelihood.LF_zRandom = static_cast<float>(ours.laser_z_rand);
  likelihood.LF_maxRange = static_cast<float>(test_support::SimulatedDriveParams{}.range_max);
  likelihood.LF_maxCorrsDistance = static_cast<float>(ours.laser_likelihood_max_dist);
  // Of 361 beams MRPT takes the 260 to 310 that end 25 mm apart, and then each fifth: 52 to 62.
  likelihood.LF_decimation = 5;
  // The deviations of our model after 0.2 m or 0.5 rad; the sideways one is that forwards here.
  // On wall faces MRPT's own model is the better one.
  if (kind == kLikeOurs) setting.motion.gaussianModel = {0.16, 0.1, 0.04, 0.1, 0.001, 0.0005};
  return setting;
}

class MrptFilter {
 public:
  MrptFilter(const COccupancyGridMap2D::Ptr& map, const MrptSetting& setting,
             const std::vector<Pose2>& start)
      : motion_(setting.motion), belief_(start.size()) {
    filter_.m_options = setting.filter;
    belief_.options.metricMap = map;
    for (std::size_t i = 0; i < start.size(); ++i) {
      belief_.m_particles[i].d = {start[i].x, start[i].y, start[i].yaw};
      belief_.m_particles[i].log_w = 0.0;
    }
  }

  /// @return odometry's frame in the map
  Pose2 Use(const RobotLog::Scan& scan, const Pose2& X_OB, double* cpu) {
    mrpt::obs::CSensoryFrame frame;
    frame.insert(Converted(scan));
    const Pose2 moved = is_first_ ? Pose2{} : X_OA_.Inverse() * X_OB;
    is_first_ = false;
    X_OA_ = X_OB;
    const double begin = CpuTime();
    CActionRobotMovement2D action;
    action.computeFromOdometry({moved.x, moved.y, moved.yaw}, motion_);
    mrpt::obs::CActionCollection actions;
    actions.insert(action);
    filter_.executeOn(belief_, &actions, &frame);
    const mrpt::poses::CPose2D mean = belief_.getMeanVal();
    *cpu += CpuTime() - begin;
    return Pose2{mean.x(), mean.y(), mean.phi()} * X_OB.Inverse();
  }

 private:
  static mrpt::obs::CObservation2DRangeScan::Ptr Converted(const RobotLog::Scan& scan) {
    const robot::ScanReading& from = scan.reading;
    auto to = mrpt::obs::CObservation2DRangeScan::Create();
    to->aperture = static_cast<float>(-2.0 * from.angle_min);
    to->maxRange = static_cast<float>(from.range_max);
    to->sensorPose = mrpt::poses::CPose3D(scan.X_BL.x, scan.X_BL.y, 0.0, scan.X_BL.yaw, 0.0, 0.0);
    to->resizeScan(from.ranges.size());
    for (std::size_t i = 0; i < from.ranges.size(); ++i) {
      to->setScanRange(i, from.ranges[i]);
      to->setScanRangeValidity(i,
                               from.ranges[i] >= from.range_min && from.ranges[i] < from.range_max);
    }
    return to;
  }

  CActionRobotMovement2D::TMotionModelOptions motion_;
  CParticleFilter filter_;
  mrpt::slam::CMonteCarloLocalization2D belief_;
  Pose2 X_OA_;  // at the last scan that was used
  bool is_first_{true};
};

/// Between scans that are used, the odometry carries the estimate on.
template <class Filter>
void Follow(const SimulatedDrive& drive, Filter filter, Tally* tally) {
  const MonteCarloParams rule;
  Pose2 X_OA, X_MO;
  std::size_t i = 0;
  for (const RobotLog::Odometry& odometry : drive.log.odometry) {
    if (i >= drive.log.scans.size() || odometry.time != drive.log.scans[i].time) continue;
    const Pose2& X_OB = odometry.reading.X_OB;
    const Pose2 moved = X_OA.Inverse() * X_OB;
    if (i == 0 || std::hypot(moved.x, moved.y) >= rule.update_min_d ||
        std::abs(geometry::WrapToPi(moved.yaw)) >= rule.update_min_a) {
      X_MO = filter.Use(drive.log.scans[i], X_OB, &tally->cpu);
      X_OA = X_OB;
      ++tally->used;
    }
    const Eigen::Vector2d truth = drive.truth[i].X_MB.position();
    if (++i <= kUnjudgedScans) continue;
    tally->squares += ((X_MO * X_OB).position() - truth).squaredNorm();
    ++tally->scans;
  }
}

COccupancyGridMap2D::Ptr MrptMap(const world::OccupancyGrid& grid,
                                 const COccupancyGridMap2D::TLikelihoodOptions& likelihood) {
  const double r = grid.resolution;
  auto map = COccupancyGridMap2D::Create();
  map->setSize(grid.origin.x(), grid.origin.x() + grid.width * r, grid.origin.y(),
               grid.origin.y() + grid.height * r, r);
  const bool is_placed = std::abs(map->getXMin() - grid.origin.x()) < 1e-3 &&
                         std::abs(map->getYMin() - grid.origin.y()) < 1e-3;
  HIRES_CHECK(is_placed, "MRPT rounds a map's corner to whole cells");
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      const world::Cell cell = grid.at(column, row);
      map->setCell(column, row,
                   cell == world::Cell::kFree       ? 1.0f
                   : cell == world::Cell::kOccupied ? 0.0f
                                                    : 0.5f);
    }
  }
  map->likelihoodOptions = likelihood;
  return map;
}

struct Place {
  bool is_judging;
  int boxes;
  auto key() const { return std::make_pair(is_judging, boxes); }
};

std::vector<Room> RoomsOf(const Place& place) {
  return place.is_judging ? localisation_benchmarks::RoomsToJudgeIn()
                          : localisation_benchmarks::RoomsToChooseIn();
}

int SeedOf(const Place& place, int repetition) {
  return (place.is_judging ? 3701 : 3301) + repetition;
}

/// For each repetition one through each room; those of one place are kept.
const std::vector<std::vector<SimulatedDrive>>& DrivesIn(const Place& place) {
  static std::optional<std::pair<bool, int>> key;
  static std::vector<std::vector<SimulatedDrive>> drives;
  if (key == place.key()) return drives;
  key = place.key();
  drives.assign(kRepetitions, {});
  for (int k = 0; k < kRepetitions; ++k) {
    const base::Rng rng(SeedOf(place, k));
    for (const Room& room : RoomsOf(place)) {
      const world::OccupancyGrid world =
          test_support::WithBoxes(room.grid, room.course, place.boxes, rng.Fork(1));
      drives[k].push_back(test_support::DriveThrough(world, room.course, {}, rng));
    }
  }
  return drives;
}

MonteCarloLocalisation OurStart(const Room& room, const SimulatedDrive& drive, int seed) {
  return {room.grid, OurParams(drive.truth.front().X_MB), base::Rng(seed).Fork(2)};
}

/// One for each repetition; computed once.
const std::vector<Tally>& Ours(const Place& place) {
  static std::map<std::pair<bool, int>, std::vector<Tally>> known;
  std::vector<Tally>& tallies = known[place.key()];
  if (!tallies.empty()) return tallies;
  const std::vector<Room> rooms = RoomsOf(place);
  tallies.resize(kRepetitions);
  for (int k = 0; k < kRepetitions; ++k) {
    for (std::size_t i = 0; i < rooms.size(); ++i) {
      const SimulatedDrive& drive = DrivesIn(place)[k][i];
      Follow(drive, OurFilter(OurStart(rooms[i], drive, SeedOf(place, k))), &tallies[k]);
    }
  }
  return tallies;
}

/// MRPT computes likelihoods of cells when it first needs them; the first repetition, which does
/// it for most of them, is repeated.
std::vector<Tally> Mrpts(const Place& place, const MrptSetting& setting) {
  const std::vector<Room> rooms = RoomsOf(place);
  std::vector<COccupancyGridMap2D::Ptr> maps;
  for (const Room& room : rooms)
    maps.push_back(MrptMap(setting.has_faces ? FacesOf(room.grid) : room.grid, setting.likelihood));
  std::vector<Tally> tallies(kRepetitions);
  for (int n = -1; n < kRepetitions; ++n) {
    const int k = std::max(0, n), seed = SeedOf(place, k);
    tallies[k] = {};
    mrpt::random::getRandomGenerator().randomize(static_cast<std::uint32_t>(seed));
    for (std::size_t i = 0; i < rooms.size(); ++i) {
      const SimulatedDrive& drive = DrivesIn(place)[k][i];
      const std::vector<Pose2> start = OurStart(rooms[i], drive, seed).ParticlePoses();
      Follow(drive, MrptFilter(maps[i], setting, start), &tallies[k]);
    }
  }
  return tallies;
}

struct Spread {
  double median, least, most;
};

Spread SpreadOf(const std::vector<Tally>& tallies, double (Tally::*value)() const) {
  std::vector<double> values;
  for (const Tally& tally : tallies) values.push_back((tally.*value)());
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  const double median =
      values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
  return {median, values.front(), values.back()};
}

void Report(const std::vector<Tally>& tallies, benchmark::State* state) {
  const Spread rms = SpreadOf(tallies, &Tally::rms_mm);
  state->counters["rms_mm"] = rms.median;
  state->counters["rms_mm_least"] = rms.least;
  state->counters["rms_mm_most"] = rms.most;
  state->counters["ms_per_scan"] = SpreadOf(tallies, &Tally::ms_per_scan).median;
  state->counters["scans_used"] = tallies.front().used;
}

Place PlaceOf(const benchmark::State& state) {
  return {state.range(0) == 1, static_cast<int>(state.range(1))};
}

bool IsThere(const Place& place, benchmark::State* state) {
  if (!RoomsOf(place).empty()) return true;
  state->SkipWithError("the original maps are not there");
  return false;
}

void BM_Ours(benchmark::State& state) {
  const Place place = PlaceOf(state);
  if (!IsThere(place, &state)) return;
  for (auto _ : state) Report(Ours(place), &state);
}

void BM_Mrpt(benchmark::State& state) {
  const Place place = PlaceOf(state);
  if (!IsThere(place, &state)) return;
  const std::vector<Tally>& ours = Ours(place);
  std::vector<Tally> mrpts;
  for (auto _ : state) mrpts = Mrpts(place, SettingOf(static_cast<Kind>(state.range(2))));
  Report(mrpts, &state);
  int num_better = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) num_better += ours[i].rms_mm() < mrpts[i].rms_mm();
  state.counters["ours_better"] = num_better;
  const auto ratio = [&](double (Tally::*value)() const) {
    return SpreadOf(mrpts, value).median / SpreadOf(ours, value).median;
  };
  state.counters["rms_ratio"] = ratio(&Tally::rms_mm);
  state.counters["ms_ratio"] = ratio(&Tally::ms_per_scan);
}

BENCHMARK(BM_Ours)
    ->ArgNames({"judge", "boxes"})
    ->ArgsProduct({{0, 1}, {0, 15}})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(BM_Mrpt)
    ->ArgNames({"judge", "boxes", "kind"})
    ->ArgsProduct({{0}, {0}, {kLikeOurs, kItsOwn, kWallFaces}})
    ->ArgsProduct({{1}, {0}, {kLikeOurs, kItsOwn, kWallFaces}})
    ->ArgsProduct({{0}, {15}, {kLikeOurs, kItsOwn, kWallFaces}})
    ->ArgsProduct({{1}, {15}, {kLikeOurs, kItsOwn, kWallFaces}})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hires::localisation
