#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "hires/base/error.h"

namespace hires::cli {

/// @param text  what was given to the option, of which the yaw is a part.
/// @throws base::ConfigError where it is more than a turn, as degrees are.
inline void RefuseDegrees(const std::string& option, const std::string& text, double yaw) {
  if (std::abs(yaw) <= 2.0 * M_PI) return;
  throw base::ConfigError(fmt::format(
      "{} '{}': yaw is in radians, wanted between -2 pi and 2 pi; {:g} degrees are {:.5g}", option,
      text, yaw, yaw * M_PI / 180.0));
}

}  // namespace hires::cli
