#pragma once

#include <cmath>

namespace hires::geometry {

constexpr double kPi = 3.14159265358979323846;

/// The same direction in (-pi, pi] [rad].
inline double WrapToPi(double angle) {
  const double wrapped = std::remainder(angle, 2.0 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

}  // namespace hires::geometry
