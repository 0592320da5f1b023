#include "hires/localisation/odometry_model.h"

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"
#include "hires/geometry/angles.h"

namespace hires::localisation {
namespace {

using geometry::kPi;
using geometry::Pose2;
using geometry::WrapToPi;

constexpr double kTurnsOnTheSpot = 0.01;  // [m] shorter moves have no direction (AMCL)

double Square(double x) { return x * x; }

/// Driving backwards is as certain as driving forwards.
double TurnThatErrs(double turn) {
  return std::min(std::abs(WrapToPi(turn)), std::abs(WrapToPi(turn - kPi)));
}

}  // namespace

MotionKind MotionKindOf(const std::string& name) {
  if (name == "diff") return MotionKind::kDiff;
  if (name == "omni") return MotionKind::kOmni;
  if (name == "diff-corrected") return MotionKind::kDiffCorrected;
  HIRES_CHECK(name == "omni-corrected", "no model of the odometry is called " + name);
  return MotionKind::kOmniCorrected;
}

MotionSampler::MotionSampler(const OdometryModelParams& params, const Pose2& X_AB)
    : is_omni_(params.kind == MotionKind::kOmni || params.kind == MotionKind::kOmniCorrected),
      trans_(std::hypot(X_AB.x, X_AB.y)),
      bearing_(std::atan2(X_AB.y, X_AB.x)),
      turn_(WrapToPi(X_AB.yaw)) {
  HIRES_CHECK(X_AB.IsFinite(), "a motion is a number");
  const bool is_variance =
      params.kind == MotionKind::kDiffCorrected || params.kind == MotionKind::kOmniCorrected;
  const auto sd = [&](double value) { return is_variance ? std::sqrt(value) : value; };
  const double moved = Square(trans_);
  if (is_omni_) {
    const double turned = Square(turn_);
    sd_trans_ = sd(params.alpha3 * moved + params.alpha1 * turned);
    sd_turn_ = sd(params.alpha4 * turned + params.alpha2 * moved);
    sd_strafe_ = sd(params.alpha1 * turned + params.alpha5 * moved);
    sd_bearing_ = 0.0;
    return;
  }
  if (trans_ < kTurnsOnTheSpot) bearing_ = 0.0;
  turn_ = WrapToPi(turn_ - bearing_);
  const double first = Square(TurnThatErrs(bearing_)), second = Square(TurnThatErrs(turn_));
  sd_bearing_ = sd(params.alpha1 * first + params.alpha2 * moved);
  sd_trans_ = sd(params.alpha3 * moved + params.alpha4 * (first + second));
  sd_turn_ = sd(params.alpha1 * second + params.alpha2 * moved);
  sd_strafe_ = 0.0;
}

Pose2 MotionSampler::Sample(base::Rng* rng) const {
  return is_omni_ ? SampleOmni(rng) : SampleDiff(rng);
}

Pose2 MotionSampler::SampleDiff(base::Rng* rng) const {
  const double bearing = rng->Normal(bearing_, sd_bearing_);
  const double trans = rng->Normal(trans_, sd_trans_);
  const double turn = rng->Normal(turn_, sd_turn_);
  return {trans * std::cos(bearing), trans * std::sin(bearing), bearing + turn};
}

Pose2 MotionSampler::SampleOmni(base::Rng* rng) const {
  const double trans = rng->Normal(trans_, sd_trans_);
  const double turn = rng->Normal(turn_, sd_turn_);
  const double strafe = rng->Normal(0.0, sd_strafe_);
  const double c = std::cos(bearing_), s = std::sin(bearing_);
  return {trans * c + strafe * s, trans * s - strafe * c, turn};
}

}  // namespace hires::localisation
