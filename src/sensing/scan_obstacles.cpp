#include "hires/sensing/scan_obstacles.h"

#include <cmath>
#include <set>
#include <utility>

#include "sensing/unmapped.h"

namespace hires::sensing {

using geometry::Polygon;
using geometry::Pose2;

ScanParams ReadScanKeys(base::ParamReader* in) {
  using base::Between;
  ScanParams params;
  params.tolerance = in->Get("tolerance", Between(0.0, 1.0));
  params.range = in->Get("range", Between(0.1, 30.0));
  params.cell = in->Get("cell", Between(0.01, 0.5));
  return params;
}

ScanObstacles::ScanObstacles(std::shared_ptr<const navigation::Costmap> map, Polygon footprint,
                             const ScanParams& params)
    : map_(std::move(map)), footprint_(std::move(footprint)), params_(params) {}

std::vector<Polygon> ScanObstacles::Find(const robot::ScanReading& scan, const Pose2& X_MB,
                                         const Pose2& X_BL) const {
  std::set<std::pair<long, long>> cells;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double range = scan.ranges[i];
    if (!(range >= scan.range_min && range <= params_.range)) continue;  // NaN included
    const double angle = scan.angle_min + static_cast<double>(i) * scan.angle_increment;
    const Eigen::Vector2d p_B =
        X_BL * Eigen::Vector2d(range * std::cos(angle), range * std::sin(angle));
    const Eigen::Vector2d p_M = X_MB * p_B;
    if (geometry::Contains(footprint_, p_B) || IsExplained(*map_, p_M, params_.tolerance)) {
      continue;
    }
    cells.emplace(std::lround(std::floor(p_M.x() / params_.cell)),
                  std::lround(std::floor(p_M.y() / params_.cell)));
  }
  std::vector<Polygon> squares;
  for (const auto& [column, row] : cells) squares.push_back(SquareOf(column, row, params_.cell));
  return squares;
}

}  // namespace hires::sensing
