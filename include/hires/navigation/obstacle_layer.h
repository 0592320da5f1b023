#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hires/geometry/polygon.h"
#include "hires/geometry/pose.h"
#include "hires/robot/readings.h"

namespace hires::navigation {

/// Defaults: the PR2's local costmap of 2015 (obstacle_range, raytrace_range).
struct ObstacleLayerParams {
  double obstacle_range{2.5};  ///< [m] so far away an echo marks
  double raytrace_range{3.0};  ///< [m] so far a beam clears
  double keep{10.0};           ///< [s] what was not seen for so long is as if it never was seen
};

/// What a laser marked and cleared round the robot, as costmap_2d's obstacle layer does: a grid
/// that rolls along in the frame of the odometry, so that what was seen stays where it is relative
/// to the robot, however wrong its place in the map may be. A value: a copy goes on like the
/// original.
class ObstacleLayer {
 public:
  enum class State : std::uint8_t { kUnseen, kFree, kObstacle };

  /// @param resolution  [m] edge of a cell, > 0.  @pre ranges > 0, keep >= 0
  ObstacleLayer(const ObstacleLayerParams& params, double resolution);

  /// Every beam clears the cells that it passes, then every echo marks its own. Echoes within the
  /// footprint are the robot's and mark nothing; what is no measurement does neither.
  /// @param time  [s] not before that of earlier scans.
  /// @param footprint  in the base.
  void Insert(double time, const robot::ScanReading& scan, const geometry::Pose2& X_OB,
              const geometry::Pose2& X_BL, const geometry::Polygon& footprint);

  /// All is unseen.
  void Forget() { cells_.assign(cells_.size(), {}); }

  State At(const Eigen::Vector2d& point_O, double time) const;
  /// Centres of all marked cells within the range that is cleared, in the frame of the odometry.
  std::vector<Eigen::Vector2d> Marks(const geometry::Pose2& X_OB, double time) const;

 private:
  struct Cell {
    std::int32_t column{0}, row{0};  // of the whole plane
    float time{0.0f};                // [s] when it was seen
    State state{State::kUnseen};
  };
  std::int32_t CellAt(double coordinate) const {
    return static_cast<std::int32_t>(std::floor(coordinate / resolution_));
  }
  std::size_t Slot(std::int32_t column, std::int32_t row) const {
    const std::int32_t mask = edge_ - 1;  // two's complement: right for negative ones, too
    return static_cast<std::size_t>(row & mask) * edge_ + (column & mask);
  }
  void Set(std::int32_t column, std::int32_t row, State state, double time) {
    cells_[Slot(column, row)] = {column, row, static_cast<float>(time), state};
  }
  void Clear(const Eigen::Vector2d& from_O, const Eigen::Vector2d& to_O, double time);

  ObstacleLayerParams params_;
  double resolution_;
  std::int32_t edge_;        // [cells] of the grid, a power of two
  std::vector<Cell> cells_;  // the plane wraps round them
};

}  // namespace hires::navigation
