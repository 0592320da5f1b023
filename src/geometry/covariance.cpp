#include "hires/geometry/covariance.h"

#include <cmath>

namespace hires::geometry {

double LargestSd(double xx, double xy, double yy) {
  return std::sqrt(0.5 * (xx + yy) + std::hypot(0.5 * (xx - yy), xy));
}

}  // namespace hires::geometry
