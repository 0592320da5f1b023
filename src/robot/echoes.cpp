#include "hires/robot/echoes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "hires/geometry/angles.h"

namespace hires::robot {
namespace {

constexpr double kNearNoise = 0.03;  // [m] three sd of a Hokuyo's noise

/// Something was there, at `range`, or, beyond range_max, nothing was. What is as short as the
/// least that it measures may be anything that is nearer. Written so that what is no number is no
/// measurement.
bool IsMeasurement(const ScanReading& reading, float range) {
  return range > 0.0f && range > static_cast<float>(reading.range_min);
}

}  // namespace

std::vector<Eigen::Vector2d> EchoesOf(const PlacedScan& scan, const geometry::Polygon& footprint) {
  const ScanReading& reading = scan.reading;
  std::vector<Eigen::Vector2d> echoes_B;
  for (std::size_t i = 0; i < reading.ranges.size(); ++i) {
    if (!IsMeasurement(reading, reading.ranges[i])) continue;
    const double range = reading.ranges[i];
    if (!std::isfinite(range)) continue;
    if (reading.range_max > 0.0 && range >= reading.range_max) continue;
    const double angle = reading.angle_min + static_cast<double>(i) * reading.angle_increment;
    const Eigen::Vector2d echo_B =
        scan.X_BL * Eigen::Vector2d(range * std::cos(angle), range * std::sin(angle));
    if (!geometry::Contains(footprint, echo_B)) echoes_B.push_back(echo_B);
  }
  return echoes_B;
}

bool HasMeasured(const ScanReading& reading) {
  return std::any_of(reading.ranges.begin(), reading.ranges.end(),
                     [&](float range) { return IsMeasurement(reading, range); });
}

bool IsTooNear(const PlacedScan& scan, const Eigen::Vector2d& point_B) {
  return (scan.X_BL.Inverse() * point_B).norm() < scan.reading.range_min + kNearNoise;
}

bool IsInView(const PlacedScan& scan, const Eigen::Vector2d& point_B) {
  const ScanReading& reading = scan.reading;
  if (reading.ranges.empty() || reading.angle_increment == 0.0) return false;
  if (IsTooNear(scan, point_B)) return false;
  const Eigen::Vector2d point_L = scan.X_BL.Inverse() * point_B;
  // Lasers that see more than half around have beams beyond pi: counted from the middle of the view
  // none is.
  const double half = 0.5 * static_cast<double>(reading.ranges.size() - 1);
  const double middle = reading.angle_min + half * reading.angle_increment;
  const double off = geometry::WrapToPi(std::atan2(point_L.y(), point_L.x()) - middle);
  const double beam = half + off / reading.angle_increment;
  if (beam < -0.5 || beam > 2.0 * half + 0.5) return false;
  const auto nearest = static_cast<std::size_t>(std::clamp(std::round(beam), 0.0, 2.0 * half));
  return IsMeasurement(reading, reading.ranges[nearest]);
}

float NearestEcho(const std::vector<float>& echoes, float range_min) {
  float nearest = std::numeric_limits<float>::quiet_NaN();
  for (const float echo : echoes) {
    if (echo >= range_min && !(nearest <= echo)) nearest = echo;
  }
  return nearest;
}

}  // namespace hires::robot
