#include "hires/navigation/slow_before.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hires/navigation/car_follower.h"
#include "navigation/velocity_window.h"

namespace hires::navigation {
namespace {

using Eigen::Vector2d;
using geometry::Pose2;
using geometry::Twist2;

constexpr double kStep = 0.01;    // [m] of the fastest corner between two looks along the arc
constexpr double kFine = 1e-4;    // [m] to which the place where it meets something is told
constexpr double kNearer = 1e-6;  // [m] less is none: rounding

/// How far a point lies outside of a convex outline, by its farthest edge; negative within.
double Outside(const geometry::Polygon& outline, const Vector2d& point) {
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector2d edge = outline[(i + 1) % outline.size()] - outline[i];
    const Vector2d normal = Vector2d(edge.y(), -edge.x()).normalized();
    most = std::max(most, normal.dot(point - outline[i]));
  }
  return most;
}

/// [s] All components come to rest at the same time; infinite where one cannot.
double BrakingTime(const Twist2& V, const SlowBeforeParams& params) {
  const double linear = std::hypot(V.vx, V.vy), angular = std::abs(V.wz);
  return std::max(linear > 0.0 ? linear / params.deceleration : 0.0,
                  angular > 0.0 ? angular / params.angular_deceleration : 0.0);
}

}  // namespace

Twist2 SlowedBefore(const Twist2& wanted, const std::vector<Vector2d>& things_B,
                    const geometry::Polygon& footprint, const SlowBeforeParams& params) {
  const double radius = geometry::CircumscribedRadius(footprint);
  const double speed = std::hypot(wanted.vx, wanted.vy) + std::abs(wanted.wz) * radius;
  if (speed <= 0.0) return wanted;
  const double deceleration = speed / BrakingTime(wanted, params);  // [m/s^2] of that corner
  if (!(deceleration > 0.0)) return {};
  const double stop = speed * params.reaction_time + 0.5 * speed * speed / deceleration;
  struct Thing {
    Vector2d p_B;
    double outside;  // [m] of the footprint, now
  };
  std::vector<Thing> near;
  for (const Vector2d& p_B : things_B) {
    if (p_B.norm() > radius + params.gap + stop + kStep) continue;
    near.push_back({p_B, Outside(footprint, p_B)});
  }
  if (near.empty()) return wanted;
  const auto is_met = [&](double way) {
    const Pose2 X_NextB = PoseAfter({}, wanted, way / speed).Inverse();
    return std::any_of(near.begin(), near.end(), [&](const Thing& thing) {
      const double outside = Outside(footprint, X_NextB * thing.p_B);
      return outside < params.gap && outside < thing.outside - kNearer;
    });
  };
  double way = 0.0;  // [m] of the fastest corner that is free
  while (way < stop && !is_met(way + kStep)) way += kStep;
  if (way >= stop) return wanted;
  for (double met = way + kStep; met - way > kFine;) {
    const double middle = 0.5 * (way + met);
    (is_met(middle) ? met : way) = middle;
  }
  const double share =
      std::min(1.0, ApproachSpeed(way, deceleration, params.reaction_time) / speed);
  return {share * wanted.vx, share * wanted.vy, share * wanted.wz};
}

}  // namespace hires::navigation
