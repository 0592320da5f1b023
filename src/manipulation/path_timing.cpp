#include "manipulation/path_timing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hires::manipulation {
namespace {

using Eigen::VectorXd;

constexpr double kCellSize = 0.02;  // [rad] or [m] of the joint that moves most
constexpr int kMaxCellsPerPiece = 256;
constexpr int kNumHalvings = 48;  // of an interval of squared speeds
constexpr double kStill = 1e-12;  // a slope below this does not move the joint

struct Range {
  double lower{-std::numeric_limits<double>::infinity()};
  double upper{std::numeric_limits<double>::infinity()};
  bool is_empty() const { return lower > upper; }
};

/// A cell before it is timed. Speeds are squared and in the cell's own u.
struct Cell {
  const PathPiece* piece;
  double u0, u1;
  VectorXd slope0, slope1, bend;  // q' at both ends, q''
  bool stops{false};              // at its end

  double width() const { return u1 - u0; }
};

/// Cells are small against kCellSize, and against the way that a joint takes to get up to its
/// speed: a torso lift does that within a millimetre. Their number is even, so that the peak of a
/// short straight way lies between two of them.
int NumCells(const PathPiece& piece, const JointBounds& bounds) {
  const VectorXd way = (piece.a1 + piece.a2).cwiseAbs();
  const VectorXd to_speed = 0.25 * bounds.velocity.cwiseAbs2().cwiseQuotient(bounds.acceleration);
  const double cells = way.cwiseQuotient(to_speed.cwiseMin(kCellSize)).maxCoeff();
  return 2 * static_cast<int>(std::clamp(std::ceil(0.5 * cells), 2.0, 0.5 * kMaxCellsPerPiece));
}

std::vector<Cell> Cut(const PathPiece& piece, const JointBounds& bounds) {
  const int n = NumCells(piece, bounds);
  std::vector<Cell> cells;
  for (int i = 0; i < n; ++i) {
    const double u0 = static_cast<double>(i) / n, u1 = static_cast<double>(i + 1) / n;
    cells.push_back({&piece, u0, u1, piece.Slope(u0), piece.Slope(u1), 2.0 * piece.a2});
  }
  cells.back().stops = piece.stops_at_end;
  return cells;
}

/// Narrows to |slope * acceleration + bend_x| <= limit.
void Narrow(double slope, double bend_x, double limit, Range* range) {
  if (std::abs(slope) < kStill) {
    if (std::abs(bend_x) > limit) range->upper = -std::numeric_limits<double>::infinity();
    return;
  }
  const double a = (-limit - bend_x) / slope, b = (limit - bend_x) / slope;
  range->lower = std::max(range->lower, std::min(a, b));
  range->upper = std::min(range->upper, std::max(a, b));
}

/// Accelerations of u that keep all joints within their bounds at both ends of the cell and lead to
/// a squared speed of at most x1_max.
Range Accelerations(const Cell& cell, double x0, double x1_max, const JointBounds& bounds) {
  const double w = 2.0 * cell.width();  // x1 = x0 + w * acceleration
  Range range{-x0 / w, (x1_max - x0) / w};
  for (Eigen::Index j = 0; j < cell.bend.size() && !range.is_empty(); ++j) {
    const double limit = bounds.acceleration[j], bend_x = cell.bend[j] * x0;
    Narrow(cell.slope0[j], bend_x, limit, &range);
    Narrow(cell.slope1[j] + w * cell.bend[j], bend_x, limit, &range);
  }
  return range;
}

/// Largest squared speed at this slope.
double SpeedLimit(const VectorXd& slope, const JointBounds& bounds) {
  double limit = std::numeric_limits<double>::infinity();
  for (Eigen::Index j = 0; j < slope.size(); ++j) {
    if (std::abs(slope[j]) < kStill) continue;
    limit = std::min(limit, bounds.velocity[j] / std::abs(slope[j]));
  }
  return limit * limit;
}

/// Largest squared speed at the cell's start from which its end can be met. 0 always can.
double LargestStart(const Cell& cell, double x1_max, const JointBounds& bounds) {
  double good = 0.0, bad = SpeedLimit(cell.slope0, bounds);
  if (!Accelerations(cell, bad, x1_max, bounds).is_empty()) return bad;
  for (int i = 0; i < kNumHalvings; ++i) {
    const double middle = 0.5 * (good + bad);
    (Accelerations(cell, middle, x1_max, bounds).is_empty() ? bad : good) = middle;
  }
  return good;
}

/// Between cells the squared speed of the joints is handed on, which does not depend on u.
double ToJoints(double x, const VectorXd& slope) { return x * slope.squaredNorm(); }
double FromJoints(double speed, const VectorXd& slope) { return speed / slope.squaredNorm(); }

/// For each cell, the largest squared speed (in u) at its end from which the rest can be driven.
std::vector<double> SweepBack(const std::vector<Cell>& cells, const JointBounds& bounds) {
  std::vector<double> x1_max(cells.size());
  double speed = 0.0;
  for (std::size_t i = cells.size(); i-- > 0;) {
    if (cells[i].stops) speed = 0.0;
    x1_max[i] = std::min(FromJoints(speed, cells[i].slope1), SpeedLimit(cells[i].slope1, bounds));
    speed = ToJoints(LargestStart(cells[i], x1_max[i], bounds), cells[i].slope0);
  }
  return x1_max;
}

TimedCell Drive(const Cell& cell, double x0, double x1_max, const JointBounds& bounds) {
  const Range range = Accelerations(cell, x0, x1_max, bounds);
  const double x1 = std::clamp(x0 + 2.0 * cell.width() * range.upper, 0.0, x1_max);
  const double acceleration = (x1 - x0) / (2.0 * cell.width());
  const double duration = 2.0 * cell.width() / (std::sqrt(x0) + std::sqrt(x1));
  return {cell.piece, cell.u0, cell.u1, x0, x1, acceleration, duration};
}

}  // namespace

std::vector<TimedCell> TimePieces(const std::vector<PathPiece>& pieces, const JointBounds& bounds) {
  std::vector<Cell> cells;
  for (const PathPiece& piece : pieces) {
    for (Cell& cell : Cut(piece, bounds)) cells.push_back(std::move(cell));
  }
  const std::vector<double> x1_max = SweepBack(cells, bounds);
  std::vector<TimedCell> timed;
  double speed = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    timed.push_back(Drive(cells[i], FromJoints(speed, cells[i].slope0), x1_max[i], bounds));
    speed = ToJoints(timed.back().x1, cells[i].slope1);
  }
  return timed;
}

}  // namespace hires::manipulation
