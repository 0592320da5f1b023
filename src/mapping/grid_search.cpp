#include "mapping/grid_search.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "hires/geometry/angles.h"

namespace hires::mapping {
namespace {

using geometry::Pose2;

constexpr double kCentreBonus = 0.05;  // of nearness, over the window
constexpr int kMostSquares = 12;       // along an axis, of the largest

int NearestToZero(int first, int last) { return std::max({0, first, -last}); }

}  // namespace

GridSearch::GridSearch(const Nearness& nearness, const std::vector<Eigen::Vector2d>& points,
                       const Pose2& guess, const SearchWindow& window, const SearchStep& step)
    : guess_(guess),
      window_(window),
      step_(step),
      most_(static_cast<int>(std::ceil(window.reach / (step.cells * Nearness::kCell)))),
      most_yaw_(static_cast<int>(std::ceil(window.yaw / step.yaw))),
      levels_{nearness} {
  for (int edge = 2; (2 * most_ + 1) > kMostSquares * edge / 2; edge *= 2)
    levels_.push_back(nearness.MostOfSquares(edge * step.cells));
  for (int yaw = -most_yaw_; yaw <= most_yaw_; ++yaw) {
    const Pose2 turned = PoseOf({yaw, 0, 0});
    std::vector<Eigen::Array2i>& cells = cells_.emplace_back();
    for (const Eigen::Vector2d& p : points) cells.push_back(nearness.CellOf(turned * p));
  }
  const int level = static_cast<int>(levels_.size()) - 1;
  for (int yaw = -most_yaw_; yaw <= most_yaw_; ++yaw) {
    for (int row = -most_; row <= most_; row += 1 << level) {
      for (int column = -most_; column <= most_; column += 1 << level)
        largest_.push_back(SquareAt(yaw, row, column, level));
    }
  }
  std::sort(largest_.begin(), largest_.end(), IsBetter);
}

bool GridSearch::IsBetter(const Square& a, const Square& b) {
  return std::tie(b.bound, a.yaw, a.row, a.column) < std::tie(a.bound, b.yaw, b.row, b.column);
}

Pose2 GridSearch::PoseOf(const Square& square) const {
  const double length = step_.cells * Nearness::kCell;
  return {guess_.x + square.column * length, guess_.y + square.row * length,
          geometry::WrapToPi(guess_.yaw + square.yaw * step_.yaw)};
}

/// How far its poses are off the guess at the least, 0 .. 1 in the window.
double GridSearch::PenaltyOf(const Square& square, int edge) const {
  const double length = step_.cells * Nearness::kCell / window_.reach;
  const double x = NearestToZero(square.column, square.column + edge - 1) * length;
  const double y = NearestToZero(square.row, square.row + edge - 1) * length;
  const double yaw = square.yaw * step_.yaw / window_.yaw;
  return (x * x + y * y + yaw * yaw) / 3.0;
}

GridSearch::Square GridSearch::SquareAt(int yaw, int row, int column, int level) const {
  const Nearness& most = levels_[level];
  int sum = 0;
  for (const Eigen::Array2i& cell : cells_[yaw + most_yaw_])
    sum += most.At(cell.x() + column * step_.cells, cell.y() + row * step_.cells);
  Square square{yaw, row, column, 0.0};
  square.bound = sum * (1.0 - kCentreBonus * PenaltyOf(square, 1 << level));
  return square;
}

void GridSearch::Look(const Square& square, int level, const std::optional<Disc>& left_out,
                      Square* best) const {
  if (!IsBetter(square, *best)) return;
  if (level == 0) {
    const Eigen::Vector2d p = PoseOf(square).position();
    if (!left_out || (p - left_out->centre).norm() >= left_out->radius) *best = square;
    return;
  }
  const int half = 1 << (level - 1);
  std::vector<Square> quarters;
  for (const int row : {square.row, square.row + half}) {
    for (const int column : {square.column, square.column + half}) {
      if (row <= most_ && column <= most_)
        quarters.push_back(SquareAt(square.yaw, row, column, level - 1));
    }
  }
  std::sort(quarters.begin(), quarters.end(), IsBetter);
  for (const Square& quarter : quarters) Look(quarter, level - 1, left_out, best);
}

GridMatch GridSearch::Best(const std::optional<Disc>& left_out) const {
  Square best;
  const int level = static_cast<int>(levels_.size()) - 1;
  for (const Square& square : largest_) Look(square, level, left_out, &best);
  return {PoseOf(best), best.bound};
}

}  // namespace hires::mapping
