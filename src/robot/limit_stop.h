#pragma once

namespace hires::robot {

inline constexpr double kLimitSlack = 1e-6;  ///< [rad] or [m] beyond a limit that is still within

/// Where a joint that follows another comes to stand: it stops at its own limits.
inline double StoppedAt(double lower, double upper, double position) {
  if (position < lower - kLimitSlack) return lower;
  if (position > upper + kLimitSlack) return upper;
  return position;
}

}  // namespace hires::robot
