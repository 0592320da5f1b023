#include "perception/tabletop/table_top.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>

namespace hires::perception {
namespace {

constexpr double kOutlineCell = 0.02;  // [m]
constexpr int kMostCells = 2000;       // along each axis; larger tables have larger cells
constexpr double kMinPiece = 0.1;      // of the largest piece
constexpr int kMinOver = 3;      // times as many points in a cell's plane as below it: a table
                                 // hides what is below it, a wall goes on there
constexpr int kMinUnder = 2;     // likewise as above it: a wall goes on there, and so does a thing,
                                 // whose cells a table can do without
constexpr double kBeside = 3.0;  // tolerances up to which points are beside a plane
constexpr double kColumn = 0.05;         // [m] edge of columns of points
constexpr std::size_t kStacked = 60000;  // points in all of them

/// -1, 1 where it lies so little below or above the plane that a wall which crosses it there has as
/// many points on it, else 0.
int SideOf(const TablePlane& plane, const TablePoint& point) {
  const double height = (plane.normal.dot(point.p) + plane.offset) / point.tolerance;
  if (std::abs(height) < 1.0 || std::abs(height) >= kBeside) return 0;
  return height < 0.0 ? -1 : 1;
}

/// Points of a plane in square cells, and which of the cells hang together. Cells in which
/// something goes on below the plane, or above it, belong to none: a table that is seen from afar
/// hides the foot of the wall behind it.
class Pieces {
 public:
  Pieces(const std::vector<Eigen::Vector2d>& points, const std::vector<Eigen::Vector2d>& below,
         const std::vector<Eigen::Vector2d>& above);
  /// Whether a point is in a piece that is not small.
  bool IsKept(std::size_t point) const { return IsCellKept(cell_[point]); }
  /// Whether it may be a corner of the hull, too: those of a cell between four others, one at each
  /// of its corners, cannot.
  bool IsAtBorder(std::size_t point) const;

 private:
  bool IsCellKept(int cell) const { return sizes_[piece_[cell]] > kMinPiece * largest_; }
  int CellOf(const Eigen::Vector2d& p) const;  // -1: beside all of them
  void DropSteepCells(const std::vector<Eigen::Vector2d>& beside, int least);
  void Spread(int first, int piece);

  Eigen::Array2d lower_;
  double edge_;                     // [m]
  int columns_, rows_;              // with an empty cell at each border
  std::vector<int> cell_;           // of each point
  std::vector<int> count_, piece_;  // of each cell; piece 0: no point is there
  std::vector<int> sizes_{0};       // points of each piece
  int largest_{0};                  // of them
};

Pieces::Pieces(const std::vector<Eigen::Vector2d>& points,
               const std::vector<Eigen::Vector2d>& below,
               const std::vector<Eigen::Vector2d>& above) {
  lower_ = points.front();
  Eigen::Array2d upper = lower_;
  for (const Eigen::Vector2d& p : points) {
    lower_ = lower_.min(p.array());
    upper = upper.max(p.array());
  }
  edge_ = std::max(kOutlineCell, (upper - lower_).maxCoeff() / kMostCells);
  columns_ = static_cast<int>((upper - lower_).x() / edge_) + 3;
  rows_ = static_cast<int>((upper - lower_).y() / edge_) + 3;
  count_.assign(static_cast<std::size_t>(columns_) * rows_, 0);
  piece_ = count_;
  for (const Eigen::Vector2d& p : points) {
    cell_.push_back(CellOf(p));
    ++count_[cell_.back()];
  }
  DropSteepCells(below, kMinOver);
  DropSteepCells(above, kMinUnder);
  for (std::size_t i = 0; i < count_.size(); ++i) {
    if (count_[i] == 0 || piece_[i] != 0) continue;
    sizes_.push_back(0);
    Spread(static_cast<int>(i), static_cast<int>(sizes_.size()) - 1);
  }
  largest_ = *std::max_element(sizes_.begin(), sizes_.end());
}

int Pieces::CellOf(const Eigen::Vector2d& p) const {
  const Eigen::Array2d cell = ((p.array() - lower_) / edge_).floor() + 1.0;
  if ((cell < 0.0).any() || cell.x() >= columns_ || cell.y() >= rows_) return -1;
  return static_cast<int>(cell.y()) * columns_ + static_cast<int>(cell.x());
}

/// @param least  times as many points in a cell's plane as beside it.
void Pieces::DropSteepCells(const std::vector<Eigen::Vector2d>& beside, int least) {
  std::vector<int> count_beside(count_.size(), 0);
  for (const Eigen::Vector2d& p : beside)
    if (const int cell = CellOf(p); cell >= 0) ++count_beside[cell];
  for (std::size_t i = 0; i < count_.size(); ++i)
    if (least * count_beside[i] > count_[i]) count_[i] = 0;
}

void Pieces::Spread(int first, int piece) {
  std::vector<int> open{first};
  while (!open.empty()) {
    const int cell = open.back();
    open.pop_back();
    if (count_[cell] == 0 || piece_[cell] != 0) continue;
    piece_[cell] = piece;
    sizes_[piece] += count_[cell];
    for (int k = 0; k < 9; ++k) open.push_back(cell + (k / 3 - 1) * columns_ + k % 3 - 1);
  }
}

bool Pieces::IsAtBorder(std::size_t point) const {
  const int cell = cell_[point];
  return IsCellKept(cell) && !(IsCellKept(cell - columns_ - 1) && IsCellKept(cell - columns_ + 1) &&
                               IsCellKept(cell + columns_ - 1) && IsCellKept(cell + columns_ + 1));
}

/// A point in a column that stands on a level plane.
struct Stacked {
  std::int64_t column;
  double height;  // [m] over that plane
  std::size_t point;
};

std::vector<Stacked> InColumns(const std::vector<TablePoint>& points, const Table& level) {
  const std::size_t step = points.size() / kStacked + 1;
  std::vector<Stacked> stacked;
  stacked.reserve(points.size() / step + 1);
  for (std::size_t i = 0; i < points.size(); i += step) {
    const Eigen::Array2d cell = (level.FromAbove(points[i].p) / kColumn).array().floor();
    const auto column = static_cast<std::int64_t>(cell.x()) * (std::int64_t{1} << 32) +
                        static_cast<std::int64_t>(cell.y());
    stacked.push_back({column, level.HeightOf(points[i].p), i});
  }
  std::sort(stacked.begin(), stacked.end(), [](const Stacked& a, const Stacked& b) {
    return std::tie(a.column, a.height, a.point) < std::tie(b.column, b.height, b.point);
  });
  return stacked;
}

/// How many of a column lie at most so far below or above one of its points.
std::ptrdiff_t CountWithin(const std::vector<Stacked>& stacked, const Stacked& one, double reach) {
  const auto is_lower = [](const Stacked& a, const std::pair<std::int64_t, double>& b) {
    return std::tie(a.column, a.height) < std::tie(b.first, b.second);
  };
  const auto from = [&](double height) {
    return std::lower_bound(stacked.begin(), stacked.end(), std::pair(one.column, height),
                            is_lower);
  };
  return from(one.height + reach) - from(one.height - reach);
}

}  // namespace

bool Supports(const TablePlane& plane, const TablePoint& point) {
  return std::abs(plane.normal.dot(point.p) + plane.offset) < point.tolerance;
}

Table TableIn(const TablePlane& plane) {
  Table table;
  table.normal = plane.normal;
  table.offset = plane.offset;
  table.along_x = plane.normal.unitOrthogonal();
  table.along_y = table.normal.cross(table.along_x);
  return table;
}

TableTop TopOf(const std::vector<TablePoint>& points, const Table& table) {
  const TablePlane plane{table.normal, table.offset};
  std::vector<TablePoint> on_it;
  std::vector<Eigen::Vector2d> from_above, below, above;
  for (const TablePoint& point : points) {
    if (Supports(plane, point)) {
      on_it.push_back(point);
      from_above.push_back(table.FromAbove(point.p));
    } else if (const int side = SideOf(plane, point); side != 0) {
      (side < 0 ? below : above).push_back(table.FromAbove(point.p));
    }
  }
  TableTop top;
  if (on_it.empty()) return top;
  const Pieces pieces(from_above, below, above);
  for (std::size_t i = 0; i < on_it.size(); ++i) {
    if (!pieces.IsKept(i)) continue;
    top.points.push_back(on_it[i]);
    if (pieces.IsAtBorder(i)) top.border.push_back(on_it[i].p);
  }
  return top;
}

std::vector<TablePoint> WithoutUpright(const std::vector<TablePoint>& points, const Table& level,
                                       double tolerances) {
  const std::vector<Stacked> stacked = InColumns(points, level);
  std::vector<TablePoint> out;
  for (const Stacked& one : stacked) {
    const TablePoint& point = points[one.point];
    const double reach = tolerances * point.tolerance;
    const std::ptrdiff_t on_it = CountWithin(stacked, one, reach);
    const std::ptrdiff_t beside = CountWithin(stacked, one, kBeside * reach) - on_it;
    if (on_it >= kMinUnder * beside) out.push_back(point);
  }
  return out;
}

}  // namespace hires::perception
