#include "hires/robot/echoes.h"

#include <cmath>

namespace hires::robot {

std::vector<Eigen::Vector2d> EchoesOf(const PlacedScan& scan, const geometry::Polygon& footprint) {
  const ScanReading& reading = scan.reading;
  std::vector<Eigen::Vector2d> echoes_B;
  for (std::size_t i = 0; i < reading.ranges.size(); ++i) {
    const double range = reading.ranges[i];
    // Written so that what is no number is none.
    if (!(range > 0.0 && range >= reading.range_min && std::isfinite(range))) continue;
    if (reading.range_max > 0.0 && range >= reading.range_max) continue;
    const double angle = reading.angle_min + static_cast<double>(i) * reading.angle_increment;
    const Eigen::Vector2d echo_B =
        scan.X_BL * Eigen::Vector2d(range * std::cos(angle), range * std::sin(angle));
    if (!geometry::Contains(footprint, echo_B)) echoes_B.push_back(echo_B);
  }
  return echoes_B;
}

}  // namespace hires::robot
