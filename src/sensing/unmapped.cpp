#include "sensing/unmapped.h"

#include <cmath>

namespace hires::sensing {

bool IsExplained(const navigation::Costmap& map, const Eigen::Vector2d& p_M, double tolerance) {
  int column = 0, row = 0;
  map.CellOf(p_M, &column, &row);
  if (!map.Inside(column, row)) return true;
  const int reach = static_cast<int>(std::ceil(tolerance / map.resolution()));
  for (int y = row - reach; y <= row + reach; ++y) {
    for (int x = column - reach; x <= column + reach; ++x) {
      if (map.Inside(x, y) && map.HasObstacle(x, y)) return true;
    }
  }
  return false;
}

geometry::Polygon SquareOf(long column, long row, double edge) {
  const double x = column * edge, y = row * edge;
  return {{x, y}, {x + edge, y}, {x + edge, y + edge}, {x, y + edge}};
}

}  // namespace hires::sensing
