#include "hires/navigation/a_star.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>

#include "hires/base/check.h"

namespace hires::navigation {
namespace {

struct Step {
  int dx, dy;
  double length;
};
const double kDiagonal = std::sqrt(2.0);
const Step kSteps[] = {{1, 0, 1.0},         {0, 1, 1.0},       {-1, 0, 1.0},
                       {0, -1, 1.0},        {1, 1, kDiagonal}, {-1, 1, kDiagonal},
                       {-1, -1, kDiagonal}, {1, -1, kDiagonal}};

struct CellIndex {
  int column, row;
};

/// Lowest estimate first; of equal ones the one nearer to the goal, then the lower cell index, so
/// that the order never depends on the history of the queue.
struct Open {
  double estimate;
  double to_goal;
  int cell;
  double cost;
  bool operator<(const Open& other) const {
    return std::tie(other.estimate, other.to_goal, other.cell) < std::tie(estimate, to_goal, cell);
  }
};

class Search {
 public:
  Search(const Costmap& costmap, CellIndex goal, const AStarParams& params)
      : costmap_(costmap), goal_(goal), params_(params) {
    const std::size_t size = static_cast<std::size_t>(costmap.width()) * costmap.height();
    cost_.assign(size, std::numeric_limits<double>::infinity());
    parent_.assign(size, -1);
  }

  bool Run(CellIndex start) {
    Reach(start, 0.0, -1);
    while (!open_.empty()) {
      const Open next = open_.top();
      open_.pop();
      if (next.cost > cost_[next.cell]) continue;  // reached more cheaply since
      if (next.cell == Id(goal_)) return true;
      Expand(next);
    }
    return false;
  }

  double cost_of_goal() const { return cost_[Id(goal_)]; }

  std::vector<CellIndex> CellsToGoal() const {
    std::vector<CellIndex> cells;
    for (int id = Id(goal_); id >= 0; id = parent_[id]) cells.push_back(CellAt(id));
    std::reverse(cells.begin(), cells.end());
    return cells;
  }

 private:
  int Id(CellIndex cell) const { return cell.row * costmap_.width() + cell.column; }
  CellIndex CellAt(int id) const { return {id % costmap_.width(), id / costmap_.width()}; }

  bool IsFree(int column, int row) const {
    return costmap_.Inside(column, row) && costmap_.cost(column, row) < kInscribedCost;
  }

  void Expand(const Open& from) {
    const CellIndex at = CellAt(from.cell);
    for (const Step& step : kSteps) {
      const CellIndex to{at.column + step.dx, at.row + step.dy};
      if (!IsFree(to.column, to.row) || !IsFree(at.column, to.row) || !IsFree(to.column, at.row)) {
        continue;
      }
      const double entered = costmap_.cost(to.column, to.row);
      const double weight = params_.neutral_cost + params_.cost_factor * entered;
      Reach(to, from.cost + step.length * weight, from.cell);
    }
  }

  void Reach(CellIndex cell, double cost, int parent) {
    const int id = Id(cell);
    if (cost >= cost_[id]) return;
    cost_[id] = cost;
    parent_[id] = parent;
    const double to_goal = Heuristic(cell);
    open_.push({cost + to_goal, to_goal, id, cost});
  }

  /// Octile distance through free cells: no path can be cheaper.
  double Heuristic(CellIndex cell) const {
    const int dx = std::abs(cell.column - goal_.column), dy = std::abs(cell.row - goal_.row);
    const double cells = std::max(dx, dy) + (kDiagonal - 1.0) * std::min(dx, dy);
    return params_.neutral_cost * cells;
  }

  const Costmap& costmap_;
  CellIndex goal_;
  AStarParams params_;
  std::vector<double> cost_;
  std::vector<int> parent_;
  std::priority_queue<Open> open_;
};

CellIndex CellOf(const Costmap& costmap, const geometry::Pose2& X_MB) {
  CellIndex cell;
  costmap.CellOf(X_MB.position(), &cell.column, &cell.row);
  return cell;
}

bool IsBlocked(const Costmap& costmap, CellIndex cell) {
  return !costmap.Inside(cell.column, cell.row) ||
         costmap.cost(cell.column, cell.row) >= kInscribedCost;
}

std::vector<geometry::Pose2> PosesAlong(const Costmap& costmap, const std::vector<CellIndex>& cells,
                                        const geometry::Pose2& X_MStart,
                                        const geometry::Pose2& X_MGoal) {
  if (cells.size() == 1) return {X_MGoal};
  std::vector<Eigen::Vector2d> points;
  points.reserve(cells.size());
  for (const CellIndex& cell : cells) points.push_back(costmap.CentreOf(cell.column, cell.row));
  points.front() = X_MStart.position();
  points.back() = X_MGoal.position();
  std::vector<geometry::Pose2> path;
  path.reserve(cells.size());
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Eigen::Vector2d ahead = points[i + 1] - points[i];
    path.push_back({points[i].x(), points[i].y(), std::atan2(ahead.y(), ahead.x())});
  }
  path.push_back(X_MGoal);
  return path;
}

}  // namespace

PathResult PlanPath(const Costmap& costmap, const geometry::Pose2& X_MStart,
                    const geometry::Pose2& X_MGoal, const AStarParams& params) {
  HIRES_CHECK(params.neutral_cost > 0.0 && params.cost_factor >= 0.0,
              "a path needs a positive neutral cost and a cost factor that is not negative");
  const CellIndex start = CellOf(costmap, X_MStart), goal = CellOf(costmap, X_MGoal);
  if (IsBlocked(costmap, start)) return {PathStatus::kStartBlocked, {}, 0.0};
  if (IsBlocked(costmap, goal)) return {PathStatus::kGoalBlocked, {}, 0.0};
  Search search(costmap, goal, params);
  if (!search.Run(start)) return {PathStatus::kNoPath, {}, 0.0};
  return {PathStatus::kFound, PosesAlong(costmap, search.CellsToGoal(), X_MStart, X_MGoal),
          search.cost_of_goal()};
}

}  // namespace hires::navigation
