#include "hires/perception/point_cloud.h"

#include <fmt/format.h>

namespace hires::perception {
namespace {

constexpr double kMaxBehind = 0.1;  // of the points
constexpr float kAbsurd = 1e4F;     // [m] farther than anything that measures distances sees

/// How drivers write that nothing was measured: NaN, a huge number of either sign, or the camera's
/// own place.
bool IsNothing(const Eigen::Vector3f& p_C) {
  return !IsMeasured(p_C) || p_C.isZero(0.0F) || p_C.cwiseAbs().maxCoeff() > kAbsurd;
}

}  // namespace

std::string TakeOnlyAhead(PointCloud* cloud) {
  constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
  long num_measured = 0, num_behind = 0;
  for (Eigen::Vector3f& p_C : cloud->points) {
    const bool is_nothing = IsNothing(p_C);
    if (!is_nothing) {
      ++num_measured;
      num_behind += p_C.z() <= 0.0F;
    }
    if (is_nothing || p_C.z() <= 0.0F) p_C.setConstant(kNothing);
  }
  if (static_cast<double>(num_behind) <= kMaxBehind * static_cast<double>(num_measured)) return "";
  return fmt::format(
      "{} of {} points lie behind the camera; wanted an optical frame (x right, y down, z forward)",
      num_behind, num_measured);
}

}  // namespace hires::perception
