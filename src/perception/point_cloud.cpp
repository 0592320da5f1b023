#include "hires/perception/point_cloud.h"

#include <fmt/format.h>

namespace hires::perception {
namespace {

constexpr double kMaxBehind = 0.1;  // of the points

}  // namespace

std::string TakeOnlyAhead(PointCloud* cloud) {
  constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
  long num_measured = 0, num_behind = 0;
  for (Eigen::Vector3f& p_C : cloud->points) {
    const bool is_itself = p_C.isZero(0.0F);
    if (IsMeasured(p_C) && !is_itself) {
      ++num_measured;
      num_behind += p_C.z() <= 0.0F;
    }
    if (is_itself || p_C.z() <= 0.0F) p_C.setConstant(kNothing);
  }
  if (static_cast<double>(num_behind) <= kMaxBehind * static_cast<double>(num_measured)) return "";
  return fmt::format(
      "{} of {} points lie behind the camera; wanted an optical frame (x right, y down, z forward)",
      num_behind, num_measured);
}

}  // namespace hires::perception
