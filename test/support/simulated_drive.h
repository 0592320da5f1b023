#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "hires/base/check.h"
#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "hires/localisation/path_error.h"
#include "hires/localisation/robot_log.h"
#include "hires/world/occupancy_grid.h"

/// Logs of robots that drive through a grid, for tests of what is made of such logs. The occupied
/// cells are the world; rays pass what is unknown.
namespace hires::test_support {

struct SimulatedDriveParams {
  double speed{0.5};             ///< [m/s]
  double turn_rate{0.6};         ///< [rad/s] on the spot, between legs
  double odometry_period{0.05};  ///< [s]
  int odometry_per_scan{4};      ///< readings
  double scale_error{0.03};      ///< of way and turn, one draw each for the drive
  double veer_error{0.02};       ///< [rad/m] sd of one draw for the drive
  double step_error{0.05};       ///< of each step, drawn for it
  double range_noise{0.02};      ///< [m]
  double range_max{30.0};        ///< [m]
  int beams{361};
  double field_of_view{geometry::kPi};  ///< [rad]
  geometry::Pose2 X_BL{0.27, 0.0, 0.0};
};

struct SimulatedDrive {
  localisation::RobotLog log;
  localisation::TimedPath truth;  ///< base in the grid's frame, one pose for each scan
};

/// [m] along a ray to the first occupied cell; infinite if there is none within `range_max`.
inline double RangeInGrid(const world::OccupancyGrid& grid, const Eigen::Vector2d& from,
                          double angle, double range_max) {
  const Eigen::Vector2d at = (from - grid.origin) / grid.resolution;
  const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
  int cell[2], step[2];
  double next[2], between[2];
  for (int axis = 0; axis < 2; ++axis) {
    cell[axis] = static_cast<int>(std::floor(at[axis]));
    step[axis] = direction[axis] > 0.0 ? 1 : -1;
    between[axis] = 1.0 / std::max(1e-12, std::abs(direction[axis]));
    next[axis] =
        (step[axis] > 0 ? cell[axis] + 1 - at[axis] : at[axis] - cell[axis]) * between[axis];
  }
  double range = 0.0;
  while (range * grid.resolution < range_max) {
    if (cell[0] < 0 || cell[1] < 0 || cell[0] >= grid.width || cell[1] >= grid.height) break;
    if (grid.at(cell[0], cell[1]) == world::Cell::kOccupied) return range * grid.resolution;
    const int axis = next[0] < next[1] ? 0 : 1;
    range = next[axis];
    next[axis] += between[axis];
    cell[axis] += step[axis];
  }
  return std::numeric_limits<double>::infinity();
}

inline robot::ScanReading ScanInGrid(const world::OccupancyGrid& grid, const geometry::Pose2& X_ML,
                                     const SimulatedDriveParams& params, base::Rng* rng) {
  robot::ScanReading scan;
  scan.angle_min = -params.field_of_view / 2.0;
  scan.angle_increment = params.field_of_view / (params.beams - 1);
  scan.range_min = 0.02;
  scan.range_max = params.range_max;
  for (int i = 0; i < params.beams; ++i) {
    const double angle = X_ML.yaw + scan.angle_min + i * scan.angle_increment;
    const double range = RangeInGrid(grid, X_ML.position(), angle, params.range_max);
    const double noise = rng->Normal(0.0, params.range_noise);
    scan.ranges.push_back(std::isinf(range) ? static_cast<float>(params.range_max)
                                            : static_cast<float>(std::max(0.0, range + noise)));
  }
  return scan;
}

/// Moves the robot and writes its log.
class SimulatedDriver {
 public:
  SimulatedDriver(const world::OccupancyGrid& grid, const geometry::Pose2& X_MB,
                  const SimulatedDriveParams& params, base::Rng rng)
      : grid_(grid), params_(params), rng_(rng), X_MB_(X_MB) {
    way_scale_ = 1.0 + rng_.Normal(0.0, params_.scale_error);
    turn_scale_ = 1.0 + rng_.Normal(0.0, params_.scale_error);
    veer_ = rng_.Normal(0.0, params_.veer_error);
    Record();
  }

  /// Turns towards a place and goes there straight.
  void GoTo(const Eigen::Vector2d& place) {
    const Eigen::Vector2d way = place - X_MB_.position();
    const double turn = geometry::WrapToPi(std::atan2(way.y(), way.x()) - X_MB_.yaw);
    const double turn_step = params_.turn_rate * params_.odometry_period;
    const int turns = static_cast<int>(std::ceil(std::abs(turn) / turn_step));
    for (int i = 0; i < turns; ++i) Step({0.0, 0.0, turn / turns});
    const int steps =
        static_cast<int>(std::ceil(way.norm() / (params_.speed * params_.odometry_period)));
    for (int i = 0; i < steps; ++i) Step({way.norm() / steps, 0.0, 0.0});
  }

  const SimulatedDrive& drive() const { return drive_; }

 private:
  void Step(const geometry::Pose2& step) {
    X_MB_ = X_MB_ * step;
    const auto erring = [&](double value) {
      return value * (1.0 + rng_.Normal(0.0, params_.step_error));
    };
    X_OB_ = X_OB_ * geometry::Pose2{erring(step.x) * way_scale_, 0.0,
                                    erring(step.yaw) * turn_scale_ + veer_ * step.x};
    time_ += params_.odometry_period;
    Record();
  }

  void Record() {
    drive_.log.odometry.push_back({time_, {X_OB_, {}}});
    if (drive_.log.odometry.size() % params_.odometry_per_scan != 1) return;
    localisation::RobotLog::Scan scan;
    scan.time = time_;
    scan.X_BL = params_.X_BL;
    scan.reading = ScanInGrid(grid_, X_MB_ * params_.X_BL, params_, &rng_);
    drive_.log.scans.push_back(scan);
    drive_.truth.push_back({time_, X_MB_});
  }

  const world::OccupancyGrid& grid_;
  SimulatedDriveParams params_;
  base::Rng rng_;
  geometry::Pose2 X_MB_, X_OB_;
  double way_scale_{1.0}, turn_scale_{1.0}, veer_{0.0}, time_{0.0};
  SimulatedDrive drive_;
};

/// From the first place to the last one, straight from each to the next.
inline SimulatedDrive DriveThrough(const world::OccupancyGrid& grid,
                                   const std::vector<Eigen::Vector2d>& places,
                                   const SimulatedDriveParams& params, base::Rng rng) {
  HIRES_CHECK(places.size() >= 2, "a drive has a beginning and an end");
  const Eigen::Vector2d way = places[1] - places[0];
  SimulatedDriver driver(grid, {places[0].x(), places[0].y(), std::atan2(way.y(), way.x())}, params,
                         rng);
  for (std::size_t i = 1; i < places.size(); ++i) driver.GoTo(places[i]);
  return driver.drive();
}

/// Of a drive whose odometry errs in nothing.
inline SimulatedDriveParams ExactOdometry() {
  SimulatedDriveParams params;
  params.scale_error = params.veer_error = params.step_error = 0.0;
  return params;
}

/// How an inertial unit's rate errs; as `gyro` of config/self_localisation.yaml.
struct RateErrors {
  double walk{0.0012};  ///< [rad / root s] by which its integral wanders
  double bias{0.0005};  ///< [rad/s]
};

/// Each `period` [s] the rate of a drive whose odometry errs in nothing.
inline std::vector<localisation::RobotLog::Inertia> RatesOf(const localisation::RobotLog& exact,
                                                            double period, const RateErrors& errors,
                                                            base::Rng rng) {
  std::vector<localisation::RobotLog::Inertia> readings;
  const auto& odometry = exact.odometry;
  std::size_t next = 1;
  for (int i = 0; next < odometry.size(); ++i) {
    const double time = odometry.front().time + i * period;
    while (next < odometry.size() && odometry[next].time < time) ++next;
    if (next == odometry.size()) break;
    const double turn =
        geometry::WrapToPi(odometry[next].reading.X_OB.yaw - odometry[next - 1].reading.X_OB.yaw);
    const double rate = turn / (odometry[next].time - odometry[next - 1].time);
    readings.push_back(
        {time, {}, rate + errors.bias + rng.Normal(0.0, errors.walk / std::sqrt(period))});
  }
  return readings;
}

/// Lets odometry tell turns that are `factor` times the real ones.
inline void ScaleTurns(double factor, localisation::RobotLog* log) {
  geometry::Pose2 before = log->odometry.front().reading.X_OB, X_OB = before;
  for (localisation::RobotLog::Odometry& odometry : log->odometry) {
    geometry::Pose2 step = before.Inverse() * odometry.reading.X_OB;
    step.yaw = factor * geometry::WrapToPi(step.yaw);
    before = odometry.reading.X_OB;
    X_OB = X_OB * step;
    odometry.reading.X_OB = X_OB;
  }
}

/// Where odometry says that the base was, at the times of the truth.
inline localisation::TimedPath OdometryAt(const localisation::TimedPath& truth,
                                          const localisation::RobotLog& log) {
  localisation::TimedPath path;
  for (const localisation::RobotLog::Odometry& odometry : log.odometry) {
    if (path.size() < truth.size() && odometry.time == truth[path.size()].time)
      path.push_back({odometry.time, odometry.reading.X_OB});
  }
  return path;
}

/// [m] after the rigid motion that fits them best.
inline double TrajectoryRms(const localisation::TimedPath& path,
                            const localisation::TimedPath& truth) {
  return localisation::ErrorOf(path, truth).rms;
}

/// 12 m x 8 m, with a wall from below that leaves a door of 3 m, and a pillar: like no turn of
/// itself.
inline world::OccupancyGrid TwoRooms() {
  world::OccupancyGrid grid{0.05, 240, 160, {0.0, 0.0}, {}};
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      const bool is_border = row < 2 || column < 2 || row >= 158 || column >= 238;
      const bool is_wall = column >= 120 && column < 123 && row < 100;
      const bool is_pillar = column >= 180 && column < 188 && row >= 60 && row < 66;
      grid.cells.push_back(is_border || is_wall || is_pillar ? world::Cell::kOccupied
                                                             : world::Cell::kFree);
    }
  }
  return grid;
}

/// With a shelf in the left room, which is seen from everywhere in it.
inline world::OccupancyGrid RoomsWithShelf() {
  world::OccupancyGrid grid = TwoRooms();
  for (int row = 56; row < 90; ++row)
    for (int column = 70; column < 90; ++column)
      grid.cells[row * grid.width + column] = world::Cell::kOccupied;
  return grid;
}

/// 24 m x 16 m, with a pillar near a corner: a laser of 5 m sees nothing in the middle.
inline world::OccupancyGrid LargeHall() {
  world::OccupancyGrid grid{0.05, 480, 320, {0.0, 0.0}, {}};
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      const bool is_border = row < 2 || column < 2 || row >= 318 || column >= 478;
      const bool is_pillar = column >= 80 && column < 90 && row >= 20 && row < 26;
      grid.cells.push_back(is_border || is_pillar ? world::Cell::kOccupied : world::Cell::kFree);
    }
  }
  return grid;
}

/// 50 m x 34 m: a corridor of 2 m round a block, alike everywhere but for doors 0.15 m deep.
inline world::OccupancyGrid CorridorRoundABlock() {
  world::OccupancyGrid grid{0.05, 1000, 680, {0.0, 0.0}, {}};
  grid.cells.assign(static_cast<std::size_t>(grid.width) * grid.height, world::Cell::kOccupied);
  const auto clear = [&](double left, double lower, double right, double upper) {
    for (int row = std::lround(lower / 0.05); row < std::lround(upper / 0.05); ++row)
      for (int column = std::lround(left / 0.05); column < std::lround(right / 0.05); ++column)
        grid.cells[row * grid.width + column] = world::Cell::kFree;
  };
  for (const double y : {1.0, 31.0}) clear(1.0, y, 49.0, y + 2.0);
  for (const double x : {1.0, 47.0}) clear(x, 1.0, x + 2.0, 33.0);
  base::Rng rng(7);
  for (const double y : {0.85, 3.0, 30.85, 33.0})
    for (double x = 4.0; x < 45.0; x += rng.Uniform(3.5, 8.5)) clear(x, y, x + 0.9, y + 0.15);
  for (const double x : {0.85, 3.0, 46.85, 49.0})
    for (double y = 4.0; y < 29.0; y += rng.Uniform(3.5, 8.5)) clear(x, y, x + 0.15, y + 0.9);
  return grid;
}

/// Once round, and 18 m more: 170 m.
inline std::vector<Eigen::Vector2d> CourseRoundABlock() {
  return {{2.0, 2.0}, {48.0, 2.0}, {48.0, 32.0}, {2.0, 32.0}, {2.0, 2.0}, {20.0, 2.0}};
}

/// Turns in the middle, where odometry alone tells how far.
inline std::vector<Eigen::Vector2d> CourseThroughLargeHall() {
  return {{2.0, 2.0}, {12.0, 8.0}, {2.0, 14.0}, {22.0, 14.0}};
}

/// Through both rooms and back, twice past the door.
inline std::vector<Eigen::Vector2d> CourseThroughTwoRooms() {
  return {{2.0, 2.0},  {2.0, 6.0}, {8.0, 6.5}, {8.0, 1.5}, {11.0, 1.5},
          {11.0, 6.5}, {5.0, 6.5}, {2.0, 6.0}, {2.0, 2.0}, {4.5, 2.0}};
}

/// With boxes of 0.4 m beside a course, 0.7 to 2.5 m from its middle.
inline world::OccupancyGrid WithBoxes(world::OccupancyGrid grid,
                                      const std::vector<Eigen::Vector2d>& course, int count,
                                      base::Rng rng) {
  const auto distance = [&](const Eigen::Vector2d& p) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < course.size(); ++i) {
      const Eigen::Vector2d leg = course[i] - course[i - 1], off = p - course[i - 1];
      const double share = std::clamp(off.dot(leg) / leg.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (off - share * leg).norm());
    }
    return nearest;
  };
  const int edge = static_cast<int>(0.4 / grid.resolution + 0.5);
  while (count > 0) {
    const int left = rng.Index(grid.width - edge), lower = rng.Index(grid.height - edge);
    const double beside = distance(grid.CentreOf(left + edge / 2, lower + edge / 2));
    if (beside < 0.7 || beside > 2.5) continue;
    --count;
    for (int row = lower; row < lower + edge; ++row)
      for (int column = left; column < left + edge; ++column)
        grid.cells[static_cast<std::size_t>(row) * grid.width + column] = world::Cell::kOccupied;
  }
  return grid;
}

/// A drive through one of the original maps: its YAML in the folder of original data, and places
/// [m] in it.
struct Course {
  std::string map;
  std::vector<Eigen::Vector2d> places;
};

/// The laboratory's rooms, and the corridor beside them.
inline std::vector<Course> OriginalCourses() {
  return {{"map_sim_origin.yaml",
           {{1.5, 7.5},
            {6.4, 7.5},
            {6.4, 12.0},
            {11.4, 12.0},
            {11.4, 7.5},
            {1.5, 7.5},
            {1.5, 12.0},
            {1.5, 7.5},
            {11.4, 7.5},
            {11.4, 12.0},
            {6.4, 12.0},
            {6.4, 7.5}}},
          {"map_pr2_origin.yaml",
           {{6.0, 12.0},
            {11.4, 12.0},
            {11.4, 7.0},
            {2.0, 7.0},
            {35.0, 7.0},
            {11.4, 7.0},
            {11.4, 12.0},
            {6.0, 12.0}}}};
}

}  // namespace hires::test_support
