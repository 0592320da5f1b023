#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "hires/perception/picture.h"

namespace hires::perception {

/// The nearest colour to red, green and blue that were computed.
inline Colour ToColour(const Eigen::Vector3d& colour) {
  Colour out;
  for (int i = 0; i < 3; ++i) {
    out[i] = static_cast<std::uint8_t>(std::lround(std::clamp(colour[i], 0.0, 255.0)));
  }
  return out;
}

}  // namespace hires::perception
