#include "hires/geometry/map_to_world.h"

#include <fmt/format.h>

#include <cmath>
#include <sstream>
#include <vector>

#include "hires/base/error.h"
#include "hires/geometry/angles.h"

namespace hires::geometry {

bool MapToWorld::is_identity() const {
  return X_WM.x == 0.0 && X_WM.y == 0.0 && X_WM.yaw == 0.0 && scale == 1.0;
}

Eigen::Vector2d MapToWorld::ToWorld(const Eigen::Vector2d& p_M) const {
  return X_WM * Eigen::Vector2d(scale * p_M);
}

Pose2 MapToWorld::ToWorld(const Pose2& X_MB) const {
  return X_WM * Pose2{scale * X_MB.x, scale * X_MB.y, X_MB.yaw};
}

Pose2 MapToWorld::ToMap(const Pose2& X_WB) const {
  const Pose2 scaled = X_WM.Inverse() * X_WB;
  return {scaled.x / scale, scaled.y / scale, scaled.yaw};
}

MapToWorld ParseMapToWorld(const std::string& text, const std::string& where) {
  std::istringstream in(text);
  std::vector<double> numbers;
  for (std::string word; in >> word;) {
    char* end = nullptr;
    const double number = std::strtod(word.c_str(), &end);
    if (*end != '\0' || !std::isfinite(number)) {
      throw base::ConfigError(
          fmt::format("{}: '{}' in '{}' is no number; wanted x y yaw scale", where, word, text));
    }
    numbers.push_back(number);
  }
  if (numbers.empty()) return {};
  if (numbers.size() != 3 && numbers.size() != 4) {
    throw base::ConfigError(
        fmt::format("{}: '{}' has {} numbers; wanted x [m], y [m], yaw [rad] and, where the map is "
                    "not true to scale, scale",
                    where, text, numbers.size()));
  }
  const MapToWorld parsed{{numbers[0], numbers[1], WrapToPi(numbers[2])},
                          numbers.size() == 4 ? numbers[3] : 1.0};
  if (parsed.scale < 0.5 || parsed.scale > 2.0) {
    throw base::ConfigError(fmt::format(
        "{}: scale is {:g}, wanted 0.5 to 2; a map of another unit is to be saved again in metres",
        where, parsed.scale));
  }
  return parsed;
}

}  // namespace hires::geometry
