#include "navigation/swept_footprint.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "navigation/velocity_window.h"

namespace hires::navigation {
namespace {

constexpr int kStride = 8;  // poses skipped in the first, coarse look

}  // namespace

SweptFootprint::SweptFootprint(Footprint footprint, double linear_step, double angular_step)
    : footprint_(std::move(footprint)),
      placed_(footprint_),
      inscribed_(geometry::InscribedRadius(footprint_.outline)),
      radius_(geometry::CircumscribedRadius(footprint_.outline)),
      linear_step_(linear_step),
      angular_step_(angular_step) {
  for (const geometry::Polygon& part : footprint_.by_layer) {
    outwards_.push_back(PaddedFromMiddle(part, 1.0));
    for (std::size_t i = 0; i < part.size(); ++i) outwards_.back()[i] -= part[i];
  }
}

int SweptFootprint::NumSteps(const Costmap& costmap, const geometry::Twist2& V_B, double duration,
                             double scale) const {
  const double driven = std::hypot(V_B.vx, V_B.vy) * duration;
  const double turned = std::abs(V_B.wz) * duration;
  const double corner_steps = (driven + turned * radius_ * scale) / (0.5 * costmap.resolution());
  const double steps = std::max({driven / linear_step_, turned / angular_step_, corner_steps});
  return std::max(1, static_cast<int>(std::ceil(steps)));
}

std::uint8_t SweptFootprint::HighestCost(const Costmap& costmap, const geometry::Pose2& X_MB,
                                         const geometry::Twist2& V_B, double duration,
                                         double scale) {
  const int steps = NumSteps(costmap, V_B, duration, scale);
  std::uint8_t highest = kFreeCost;
  const auto look = [&](int step) {
    const geometry::Pose2 X_MStep = PoseAfter(X_MB, V_B, duration * step / steps);
    highest = std::max(highest, CostAt(costmap, X_MStep, scale));
    return highest < kLethalCost;
  };
  // The far end collides first, if anything does: look there first.
  for (int step = steps; step >= 0; step -= kStride) {
    if (!look(step)) return highest;
  }
  for (int step = steps; step >= 0; --step) {
    if ((steps - step) % kStride != 0 && !look(step)) return highest;
  }
  return highest;
}

std::uint8_t SweptFootprint::CostAt(const Costmap& costmap, const geometry::Pose2& X_MB,
                                    double scale) {
  const double c = std::cos(X_MB.yaw), s = std::sin(X_MB.yaw);
  const auto place = [&](const Eigen::Vector2d& p, double by) {
    const double along = by * c, across = by * s;
    return Eigen::Vector2d(X_MB.x + along * p.x() - across * p.y(),
                           X_MB.y + across * p.x() + along * p.y());
  };
  for (std::size_t i = 0; i < footprint_.outline.size(); ++i)
    placed_.outline[i] = place(footprint_.outline[i], scale);
  const double growth = (scale - 1.0) * inscribed_;
  for (std::size_t k = 0; k < outwards_.size(); ++k) {
    const geometry::Polygon& part = footprint_.by_layer[k];
    for (std::size_t i = 0; i < part.size(); ++i)
      placed_.by_layer[k][i] = place(part[i] + growth * outwards_[k][i], 1.0);
  }
  return costmap.CostBelow(placed_);
}

}  // namespace hires::navigation
