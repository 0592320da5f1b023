#include "hires/navigation/reeds_shepp.h"

#include <ompl/base/ScopedState.h>
#include <ompl/base/spaces/ReedsSheppStateSpace.h>

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"
#include "navigation/velocity_window.h"

namespace hires::navigation {
namespace {

namespace ob = ompl::base;
using geometry::Pose2;

constexpr double kShortest = 1e-9;  // [m] of an arc; what is shorter is rounding

}  // namespace

Pose2 EndOf(const Pose2& X_MA, const CarArc& arc, double share) {
  const double along = std::copysign(1.0, arc.length);
  return PoseAfter(X_MA, {along, 0.0, along * arc.curvature}, share * std::abs(arc.length));
}

int NumPieces(const CarArc& arc, double spacing) {
  HIRES_CHECK(spacing > 0.0, "poses along a way keep a distance");
  return std::max(1, static_cast<int>(std::ceil(std::abs(arc.length) / spacing)));
}

void AppendPoses(const Pose2& X_MA, const std::vector<CarArc>& arcs, double spacing,
                 std::vector<CarPose>* poses) {
  Pose2 X_MBegin = X_MA;
  for (const CarArc& arc : arcs) {
    const int pieces = NumPieces(arc, spacing);
    for (int i = 1; i <= pieces; ++i) {
      poses->push_back(
          {EndOf(X_MBegin, arc, static_cast<double>(i) / pieces), arc.curvature, arc.length < 0.0});
    }
    X_MBegin = poses->back().X_MB;
  }
}

double LengthOf(const std::vector<CarArc>& arcs) {
  double length = 0.0;
  for (const CarArc& arc : arcs) length += std::abs(arc.length);
  return length;
}

struct ReedsSheppWays::Impl {
  explicit Impl(double radius)
      : radius(radius),
        space(std::make_shared<ob::ReedsSheppStateSpace>(radius)),
        from(space),
        to(space) {}

  ob::ReedsSheppStateSpace::ReedsSheppPath Between(const Pose2& X_MA, const Pose2& X_MB) {
    from->setXY(X_MA.x, X_MA.y);
    from->setYaw(X_MA.yaw);
    to->setXY(X_MB.x, X_MB.y);
    to->setYaw(X_MB.yaw);
    return space->reedsShepp(from.get(), to.get());
  }

  double radius;
  std::shared_ptr<ob::ReedsSheppStateSpace> space;
  ob::ScopedState<ob::SE2StateSpace> from, to;
};

ReedsSheppWays::ReedsSheppWays(double radius) {
  HIRES_CHECK(radius > 0.0 && std::isfinite(radius), "a car has a turning radius");
  impl_ = std::make_unique<Impl>(radius);
}
ReedsSheppWays::~ReedsSheppWays() = default;

std::vector<CarArc> ReedsSheppWays::Shortest(const Pose2& X_MA, const Pose2& X_MB) const {
  const auto way = impl_->Between(X_MA, X_MB);
  std::vector<CarArc> arcs;
  for (int i = 0; i < 5; ++i) {
    const double length = way.length_[i] * impl_->radius;
    if (way.type_[i] == ob::ReedsSheppStateSpace::RS_NOP || std::abs(length) < kShortest) continue;
    const double curvature = way.type_[i] == ob::ReedsSheppStateSpace::RS_LEFT    ? 1.0
                             : way.type_[i] == ob::ReedsSheppStateSpace::RS_RIGHT ? -1.0
                                                                                  : 0.0;
    arcs.push_back({length, curvature / impl_->radius});
  }
  return arcs;
}

double ReedsSheppWays::Distance(const Pose2& X_MA, const Pose2& X_MB) const {
  return impl_->Between(X_MA, X_MB).length() * impl_->radius;
}

}  // namespace hires::navigation
