#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/navigation/costmap.h"

namespace hires::navigation {

/// The square part of a costmap around the robot, with which cells its centre may be in.
class LocalWindow {
 public:
  /// All cells whose distance from the robot's cell is at most `half_width` [m] in x and y.
  void Centre(const Costmap& costmap, const Eigen::Vector2d& p_MB, double half_width);

  int width() const { return width_; }
  /// Index of the window's cell below a point, or -1 outside.
  int CellBelow(const Eigen::Vector2d& point_M) const;
  /// Where to interpolate at a point, or nothing outside.
  struct Place {
    int cell;          ///< that the point lies in
    int lower_left;    ///< of the four cells whose centres surround the point
    double right, up;  ///< from the lower left one's centre [cells], 0..1
  };
  std::optional<Place> Around(const Eigen::Vector2d& point_M) const;
  const std::vector<std::uint8_t>& passable() const { return passable_; }  ///< row by row; border 0

 private:
  int width_{0};  // with a border of one impassable cell
  double resolution_{1.0};
  Eigen::Vector2d corner_{Eigen::Vector2d::Zero()};
  std::vector<std::uint8_t> passable_;
};

/// Walking distance of every cell of a window to the nearest seed, over edges of free cells, as the
/// MapGrid of base_local_planner.
class DistanceGrid {
 public:
  static constexpr int kUnreachable = 1 << 20;  ///< [cells] blocked, or no way leads there

  /// @param seeds  Cells of the window (those of -1 are ignored); a blocked seed counts as well.
  void Compute(const LocalWindow& window, const std::vector<int>& seeds);

  int At(int cell) const { return distance_[cell]; }  ///< [cells]

  /// [cells] Interpolated between the four centres around the place, so that a motion of less than
  /// a cell counts too; the distance of the cell below where one of the four is unreachable.
  double At(const LocalWindow::Place& place) const;

 private:
  std::vector<int> distance_;
  std::vector<int> queue_;
  // What the distances were computed for: mostly the robot is still in the same cell, and nothing
  // has changed.
  std::vector<int> seeds_;
  std::vector<std::uint8_t> passable_;
  int width_{0};
};

}  // namespace hires::navigation
