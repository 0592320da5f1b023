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

/// Poses of one yaw whose columns and rows begin at these.
struct Square {
  int yaw{0}, row{0}, column{0};  // in steps from the guess
  double bound{0.0};              // no pose of it scores more
};

bool IsBetter(const Square& a, const Square& b) {
  return std::tie(b.bound, a.yaw, a.row, a.column) < std::tie(a.bound, b.yaw, b.row, b.column);
}

int NearestToZero(int first, int last) { return std::max({0, first, -last}); }

class Search {
 public:
  Search(const Nearness& nearness, const std::vector<Eigen::Vector2d>& points, const Pose2& guess,
         const SearchWindow& window, const SearchStep& step, const std::optional<Disc>& left_out);
  GridMatch Best();

 private:
  Square SquareAt(int yaw, int row, int column, int level) const;
  void Look(const Square& square, int level);
  double PenaltyOf(const Square& square, int edge) const;
  Pose2 PoseOf(const Square& square) const;
  bool IsLeftOut(const Pose2& pose) const;

  const Pose2& guess_;
  const SearchWindow& window_;
  const SearchStep& step_;
  const std::optional<Disc>& left_out_;
  int most_, most_yaw_;                             // steps to either side
  std::vector<Nearness> levels_;                    // most of squares of 2^level steps
  std::vector<std::vector<Eigen::Array2i>> cells_;  // of the points, for each yaw
  Square best_;
};

Search::Search(const Nearness& nearness, const std::vector<Eigen::Vector2d>& points,
               const Pose2& guess, const SearchWindow& window, const SearchStep& step,
               const std::optional<Disc>& left_out)
    : guess_(guess),
      window_(window),
      step_(step),
      left_out_(left_out),
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
}

Pose2 Search::PoseOf(const Square& square) const {
  const double length = step_.cells * Nearness::kCell;
  return {guess_.x + square.column * length, guess_.y + square.row * length,
          geometry::WrapToPi(guess_.yaw + square.yaw * step_.yaw)};
}

/// How far its poses are off the guess at the least, 0 .. 1 in the window.
double Search::PenaltyOf(const Square& square, int edge) const {
  const double length = step_.cells * Nearness::kCell / window_.reach;
  const double x = NearestToZero(square.column, square.column + edge - 1) * length;
  const double y = NearestToZero(square.row, square.row + edge - 1) * length;
  const double yaw = square.yaw * step_.yaw / window_.yaw;
  return (x * x + y * y + yaw * yaw) / 3.0;
}

Square Search::SquareAt(int yaw, int row, int column, int level) const {
  const Nearness& most = levels_[level];
  int sum = 0;
  for (const Eigen::Array2i& cell : cells_[yaw + most_yaw_])
    sum += most.At(cell.x() + column * step_.cells, cell.y() + row * step_.cells);
  Square square{yaw, row, column, 0.0};
  square.bound = sum * (1.0 - kCentreBonus * PenaltyOf(square, 1 << level));
  return square;
}

bool Search::IsLeftOut(const Pose2& pose) const {
  return left_out_ && (pose.position() - left_out_->centre).norm() < left_out_->radius;
}

void Search::Look(const Square& square, int level) {
  if (!IsBetter(square, best_)) return;
  if (level == 0) {
    if (!IsLeftOut(PoseOf(square))) best_ = square;
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
  for (const Square& quarter : quarters) Look(quarter, level - 1);
}

GridMatch Search::Best() {
  best_.bound = -1.0;
  const int level = static_cast<int>(levels_.size()) - 1;
  std::vector<Square> squares;
  for (int yaw = -most_yaw_; yaw <= most_yaw_; ++yaw) {
    for (int row = -most_; row <= most_; row += 1 << level) {
      for (int column = -most_; column <= most_; column += 1 << level)
        squares.push_back(SquareAt(yaw, row, column, level));
    }
  }
  std::sort(squares.begin(), squares.end(), IsBetter);
  for (const Square& square : squares) Look(square, level);
  return {PoseOf(best_), best_.bound};
}

}  // namespace

GridMatch SearchGrid(const Nearness& nearness, const std::vector<Eigen::Vector2d>& points,
                     const Pose2& guess, const SearchWindow& window, const SearchStep& step,
                     const std::optional<Disc>& left_out) {
  return Search(nearness, points, guess, window, step, left_out).Best();
}

}  // namespace hires::mapping
