#include <cmath>

#include "hires/base/check.h"
#include "hires/geometry/angles.h"
#include "hires/simulation/self_localisation.h"

namespace hires::simulation {
namespace {

using geometry::Pose2;

constexpr double kStill = 1e-7;  // [m] casters that move less do not steer
constexpr std::array<double, 2> kSides{1.0, -1.0};

Eigen::Vector2d Along(double angle) { return {std::cos(angle), std::sin(angle)}; }

/// How a point of the base moves when the base turns by 1 rad.
Eigen::Vector2d LeftOf(const Eigen::Vector2d& p_B) { return {-p_B.y(), p_B.x()}; }

/// A short motion as a straight way in the middle of its turn: (x, y, yaw).
Eigen::Vector3d StepOf(const Pose2& X_AB) {
  const Pose2 half{0.0, 0.0, -0.5 * X_AB.yaw};
  const Eigen::Vector2d way = half * X_AB.position();
  return {way.x(), way.y(), X_AB.yaw};
}

Pose2 MovedBy(const Pose2& X_OB, const Eigen::Vector3d& step) {
  const Pose2 half{0.0, 0.0, 0.5 * step.z()};
  return X_OB * half * Pose2{step.x(), step.y(), 0.0} * half;
}

/// By which a caster steers that is to move along `way`: it rolls backwards rather than steer by
/// more than a right angle.
double SteerOf(double angle, const Eigen::Vector2d& way) {
  if (way.norm() < kStill) return 0.0;
  const double turn = geometry::WrapToPi(std::atan2(way.y(), way.x()) - angle);
  if (std::abs(turn) <= geometry::kPi / 2) return turn;
  return geometry::WrapToPi(turn + geometry::kPi);
}

}  // namespace

WheelOdometry::WheelOdometry(const CasterParams& params, base::Rng rng)
    : params_(params), rng_(rng) {
  HIRES_CHECK(params.casters_B.size() >= 2, "two casters at least tell how a base turns");
  const double wear = rng_.Normal(0.0, params.wear);
  for (const Eigen::Vector2d& at_B : params.casters_B) {
    Caster caster{at_B, 0.0, {}};
    for (Wheel& wheel : caster.wheels)
      wheel.growth = 1.0 + wear + rng_.Normal(0.0, params.radius_error);
    casters_.push_back(caster);
  }
}

/// [m] that a wheel tells of having rolled so far.
double WheelOdometry::Told(Wheel* wheel, double rolled, double steered) {
  const double sd = std::sqrt(params_.slip * params_.slip * std::abs(rolled) +
                              params_.scrub * params_.scrub * std::abs(steered));
  const double before = wheel->counts;
  wheel->way += wheel->growth * rolled + rng_.Normal(0.0, sd);
  wheel->counts = params_.resolution > 0.0
                      ? params_.resolution * std::floor(wheel->way / params_.resolution)
                      : wheel->way;
  return wheel->counts - before;
}

void WheelOdometry::Roll(const Pose2& X_AB) {
  const Eigen::Vector3d step = StepOf(X_AB);
  // Least squares over what each wheel says of the motion: so far along it, and not across.
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  const auto add = [&](const Eigen::Vector2d& direction, const Eigen::Vector2d& at_B, double way) {
    const Eigen::Vector3d row(direction.x(), direction.y(), direction.dot(LeftOf(at_B)));
    normal += row * row.transpose();
    right += row * way;
  };
  for (Caster& caster : casters_) {
    const Eigen::Vector2d way = step.head<2>() + step.z() * LeftOf(caster.at_B);
    const double steered = SteerOf(caster.angle, way);
    caster.angle = geometry::WrapToPi(caster.angle + steered);
    const Eigen::Vector2d along = Along(caster.angle);
    for (std::size_t i = 0; i < kSides.size(); ++i) {
      const double arm = 0.5 * params_.track * kSides[i];
      const double told =
          Told(&caster.wheels[i], along.dot(way) - arm * (step.z() + steered), steered);
      const Eigen::Vector2d at_B = caster.at_B + arm * LeftOf(along);
      add(along, at_B, told + arm * steered);
      add(LeftOf(along), at_B, 0.0);
    }
  }
  X_OB_ = MovedBy(X_OB_, normal.ldlt().solve(right));
}

}  // namespace hires::simulation
