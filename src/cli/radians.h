#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>

#include "hires/base/error.h"
#include "hires/base/radians.h"

namespace hires::cli {

/// @param text  what was given to the option, of which the yaw is a part.
/// @throws base::ConfigError where it is more than a turn, as degrees are.
inline void RefuseDegrees(const std::string& option, const std::string& text, double yaw) {
  const std::optional<std::string> why = base::WhyNoRadians(yaw);
  if (why) throw base::ConfigError(fmt::format("{} '{}': its yaw {}", option, text, *why));
}

}  // namespace hires::cli
