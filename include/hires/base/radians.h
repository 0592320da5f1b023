#pragma once

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>

namespace hires::base {

/// Why an angle [rad] from a file or a command line is none: it is more than a turn, as angles in
/// degrees are. A turn that was rounded upwards (6.2832, 6.284) is one.
inline std::optional<std::string> WhyNoRadians(double angle) {
  constexpr double kTurn = 6.284;
  if (std::abs(angle) <= kTurn) return std::nullopt;
  return fmt::format(
      "is {:g}, more than a turn, wanted radians between -2 pi and 2 pi; {:g} degrees are {:.5g}",
      angle, angle, angle * M_PI / 180.0);
}

}  // namespace hires::base
