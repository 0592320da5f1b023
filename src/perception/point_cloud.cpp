#include "hires/perception/point_cloud.h"

#include <fmt/format.h>

namespace hires::perception {
namespace {

constexpr double kMaxBehind = 0.1;   // of the points
constexpr double kMaxAside = 0.02;   // of the points; cameras measure none of them
constexpr float kTanAside = 2.145F;  // of 65 degrees, off the axis along which the camera looks
constexpr float kAbsurd = 1e4F;      // [m] farther than anything that measures distances sees

/// How drivers write that nothing was measured: NaN, a huge number of either sign, or the camera's
/// own place.
bool IsNothing(const Eigen::Vector3f& p_C) {
  return !IsMeasured(p_C) || p_C.isZero(0.0F) || p_C.cwiseAbs().maxCoeff() > kAbsurd;
}

std::string WrongFrame(long count, double most, long num_measured, const char* where) {
  if (static_cast<double>(count) <= most * static_cast<double>(num_measured)) return "";
  return fmt::format("{} of {} points lie {}; wanted an optical frame (x right, y down, z forward)",
                     count, num_measured, where);
}

}  // namespace

std::string TakeOnlyAhead(PointCloud* cloud) {
  constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
  long num_measured = 0, num_behind = 0, num_aside = 0;
  for (Eigen::Vector3f& p_C : cloud->points) {
    const bool is_nothing = IsNothing(p_C);
    if (!is_nothing) {
      ++num_measured;
      num_behind += p_C.z() <= 0.0F;
      num_aside += p_C.z() > 0.0F && p_C.head<2>().norm() > kTanAside * p_C.z();
    }
    if (is_nothing || p_C.z() <= 0.0F) p_C.setConstant(kNothing);
  }
  const std::string why = WrongFrame(num_behind, kMaxBehind, num_measured, "behind the camera");
  if (!why.empty()) return why;
  return WrongFrame(num_aside, kMaxAside, num_measured,
                    "more than 65 degrees off the z axis, along which the camera looks");
}

}  // namespace hires::perception
