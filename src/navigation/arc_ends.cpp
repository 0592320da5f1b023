#include "navigation/arc_ends.h"

#include <cmath>

#include "hires/geometry/angles.h"
#include "navigation/velocity_window.h"

namespace hires::navigation {

ArcEnds::ArcEnds(const geometry::Pose2& X_MB, double duration, double ahead)
    : X_MB_(X_MB),
      c_(std::cos(X_MB.yaw)),
      s_(std::sin(X_MB.yaw)),
      duration_(duration),
      ahead_(ahead) {}

const ArcEnds::Turn& ArcEnds::TurnOf(double wz) {
  for (std::size_t tried = 0; tried < turns_.size(); ++tried) {
    if (next_ >= turns_.size()) next_ = 0;
    if (turns_[next_].wz == wz) return turns_[next_++];
    ++next_;
  }
  const ArcIntegrals arc = IntegralsAlong(wz, duration_);
  const double yaw = geometry::WrapToPi(X_MB_.yaw + wz * duration_);
  turns_.push_back({wz, arc.along, arc.across, {std::cos(yaw) * ahead_, std::sin(yaw) * ahead_}});
  next_ = turns_.size();
  return turns_.back();
}

ArcEnds::End ArcEnds::Of(const geometry::Twist2& V_B) {
  const Turn& turn = TurnOf(V_B.wz);
  const double x = V_B.vx * turn.along - V_B.vy * turn.across;
  const double y = V_B.vx * turn.across + V_B.vy * turn.along;
  const Eigen::Vector2d p_MB(X_MB_.x + c_ * x - s_ * y, X_MB_.y + s_ * x + c_ * y);
  return {p_MB, p_MB + turn.p_BF};
}

}  // namespace hires::navigation
