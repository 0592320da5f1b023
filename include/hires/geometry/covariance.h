#pragma once

namespace hires::geometry {

/// Standard deviation [m] of a position in its worst direction, from its covariance [m^2]; no
/// number where it is not.
double LargestSd(double xx, double xy, double yy);

}  // namespace hires::geometry
