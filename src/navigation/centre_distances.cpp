#include "navigation/centre_distances.h"

#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace hires::navigation {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

CentreDistances::CentreDistances(const Costmap& costmap, const Eigen::Vector2d& p_MGoal,
                                 const Eigen::Vector2d& p_MStart, const AStarParams& costs)
    : costmap_(costmap),
      cost_(static_cast<std::size_t>(costmap.width()) * costmap.height(), kInfinity) {
  const auto index = [&](int column, int row) { return row * costmap.width() + column; };
  const auto cell_of = [&](const Eigen::Vector2d& p, int* column, int* row) {
    costmap.CellOf(p, column, row);
    return costmap.Inside(*column, *row) ? index(*column, *row) : -1;
  };
  int column = 0, row = 0;
  const int start = cell_of(p_MStart, &column, &row), goal = cell_of(p_MGoal, &column, &row);
  if (goal < 0) return;
  const auto is_free = [&](int x, int y) {
    return costmap.Inside(x, y) && (costmap.cost(x, y) < kInscribedCost || index(x, y) == start);
  };
  using Reached = std::pair<double, int>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
  cost_[goal] = 0.0;
  open.emplace(0.0, goal);
  const double weight = costs.cost_factor / costs.neutral_cost;
  while (!open.empty()) {
    const auto [cost, cell] = open.top();
    open.pop();
    if (cost > cost_[cell]) continue;
    const int x = cell % costmap.width(), y = cell / costmap.width();
    const double per_metre = 1.0 + weight * costmap.cost(x, y);
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (!is_free(x + dx, y + dy)) continue;
        const double reached = cost + costmap.resolution() * std::hypot(dx, dy) * per_metre;
        double& known = cost_[index(x + dx, y + dy)];
        if (reached >= known) continue;
        known = reached;
        open.emplace(reached, index(x + dx, y + dy));
      }
    }
  }
}

double CentreDistances::At(const Eigen::Vector2d& p_MB) const {
  int column = 0, row = 0;
  costmap_.CellOf(p_MB, &column, &row);
  if (!costmap_.Inside(column, row)) return kInfinity;
  return cost_[static_cast<std::size_t>(row) * costmap_.width() + column];
}

}  // namespace hires::navigation
