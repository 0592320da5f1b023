#include "perception/tabletop/seen_depth.h"

#include <algorithm>

namespace hires::perception {
namespace {

int PixelAlong(double tangent, int pixels) {
  return std::clamp(static_cast<int>((tangent + 1.0) * pixels / 2), 0, pixels - 1);
}

}  // namespace

SeenDepth::SeenDepth(const PointCloud& cloud)
    : nearest_(std::size_t{kPixels} * kPixels, -1), depth_(nearest_.size(), 0.0F) {
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3f& p = cloud.points[i];
    if (!IsMeasured(p)) continue;
    const std::size_t pixel = std::size_t{kPixels} * PixelAlong(p.y() / p.z(), kPixels) +
                              PixelAlong(p.x() / p.z(), kPixels);
    if (nearest_[pixel] >= 0 && depth_[pixel] <= p.z()) continue;
    nearest_[pixel] = static_cast<int>(i);
    depth_[pixel] = p.z();
  }
}

int SeenDepth::PointTowards(const Eigen::Vector3d& p_C) const {
  const int column = PixelAlong(p_C.x() / p_C.z(), kPixels);
  const int row = PixelAlong(p_C.y() / p_C.z(), kPixels);
  const int own = nearest_[std::size_t{kPixels} * row + column];
  if (own >= 0) return own;
  std::size_t best = 0;
  bool is_found = false;
  for (int y = std::max(row - 1, 0); y <= std::min(row + 1, kPixels - 1); ++y) {
    for (int x = std::max(column - 1, 0); x <= std::min(column + 1, kPixels - 1); ++x) {
      const std::size_t pixel = std::size_t{kPixels} * y + x;
      if (nearest_[pixel] < 0 || (is_found && depth_[best] <= depth_[pixel])) continue;
      best = pixel;
      is_found = true;
    }
  }
  return is_found ? nearest_[best] : -1;
}

}  // namespace hires::perception
