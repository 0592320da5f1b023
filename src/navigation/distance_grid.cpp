#include "navigation/distance_grid.h"

#include <algorithm>
#include <cmath>

namespace hires::navigation {

void LocalWindow::Centre(const Costmap& costmap, const Eigen::Vector2d& p_MB, double half_width) {
  resolution_ = costmap.resolution();
  const int reach = static_cast<int>(std::floor(half_width / resolution_));
  width_ = 2 * reach + 3;
  int column, row;
  costmap.CellOf(p_MB, &column, &row);
  column -= reach + 1;
  row -= reach + 1;
  corner_ = costmap.CentreOf(column, row) - Eigen::Vector2d::Constant(0.5 * resolution_);
  passable_.assign(static_cast<std::size_t>(width_) * width_, 0);
  // Columns and rows of the window, its border left out, that lie on the map.
  const int left = std::max(1, -column), right = std::min(width_ - 1, costmap.width() - column);
  const int lower = std::max(1, -row), upper = std::min(width_ - 1, costmap.height() - row);
  for (int y = lower; y < upper; ++y) {
    for (int x = left; x < right; ++x) {
      passable_[y * width_ + x] = costmap.cost(column + x, row + y) < kInscribedCost;
    }
  }
}

int LocalWindow::CellBelow(const Eigen::Vector2d& point_M) const {
  const double x = (point_M.x() - corner_.x()) / resolution_;
  const double y = (point_M.y() - corner_.y()) / resolution_;
  if (!(x >= 1.0 && y >= 1.0 && x < width_ - 1 && y < width_ - 1)) return -1;
  return static_cast<int>(y) * width_ + static_cast<int>(x);
}

std::optional<LocalWindow::Place> LocalWindow::Around(const Eigen::Vector2d& point_M) const {
  const int cell = CellBelow(point_M);
  if (cell < 0) return std::nullopt;
  const Eigen::Vector2d p = (point_M - corner_) / resolution_ - Eigen::Vector2d::Constant(0.5);
  const double x = std::floor(p.x()), y = std::floor(p.y());
  return Place{cell, static_cast<int>(y) * width_ + static_cast<int>(x), p.x() - x, p.y() - y};
}

void DistanceGrid::Compute(const LocalWindow& window, const std::vector<int>& seeds) {
  const std::vector<std::uint8_t>& passable = window.passable();
  if (seeds == seeds_ && width_ == window.width() && passable == passable_) return;
  seeds_ = seeds;
  passable_ = passable;
  width_ = window.width();
  distance_.assign(passable.size(), kUnreachable);
  queue_.resize(passable.size());
  std::size_t end = 0;
  for (int seed : seeds) {
    if (seed < 0 || distance_[seed] == 0) continue;
    distance_[seed] = 0;
    queue_[end++] = seed;
  }
  const int neighbours[] = {1, -1, window.width(), -window.width()};
  for (std::size_t next = 0; next < end; ++next) {
    const int cell = queue_[next], farther = distance_[cell] + 1;
    for (int step : neighbours) {
      const int to = cell + step;
      if (!passable[to] || distance_[to] <= farther) continue;
      distance_[to] = farther;
      queue_[end++] = to;
    }
  }
}

double DistanceGrid::At(const LocalWindow::Place& place) const {
  const int* below = &distance_[place.lower_left];
  const int* above = below + width_;
  if (std::max({below[0], below[1], above[0], above[1]}) >= kUnreachable) return At(place.cell);
  const double lower = below[0] + place.right * (below[1] - below[0]);
  const double upper = above[0] + place.right * (above[1] - above[0]);
  return lower + place.up * (upper - lower);
}

}  // namespace hires::navigation
