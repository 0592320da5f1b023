#include "hires/world/standing.h"

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"

namespace hires::world {
namespace {

using geometry::Pose3;

constexpr double kRounding = 1e-9;  // [s] of times that are sums of steps

Fall FallOf(const StandingCriterion& criterion, const Departure& departure, bool leans) {
  if (leans) return Fall::kToppled;
  if (!IsAway(criterion, departure)) return Fall::kNone;
  return departure.drop > criterion.drop ? Fall::kDropped : Fall::kSlid;
}

}  // namespace

StandingCriterion ReadStandingCriterion(base::ParamReader in) {
  StandingCriterion criterion;
  criterion.tilt = in.Get("tilt", base::Between(0.01, 3.0));
  criterion.hold_time = in.Get("hold_time", base::Between(0.0, 10.0));
  criterion.drop = in.Get("drop", base::Between(0.005, 10.0));
  criterion.slide = in.Get("slide", base::Between(0.005, 10.0));
  in.RejectUnknownKeys();
  return criterion;
}

Departure DepartureFrom(const Pose3& X_CstoodO, const Pose3& X_CO) {
  const Eigen::Vector3d way = X_CO.translation - X_CstoodO.translation;
  return {geometry::TiltOf(X_CO.rotation), -way.z(), way.head<2>().norm()};
}

bool IsAway(const StandingCriterion& criterion, const Departure& departure) {
  return departure.drop > criterion.drop || departure.slide > criterion.slide;
}

bool IsWorse(Fall fall, Fall than) {
  if (than == Fall::kSlid) return fall != Fall::kNone && fall != Fall::kSlid;
  return than == Fall::kNone && fall != Fall::kNone;
}

bool IsUpright(const StandingCriterion& criterion, const Pose3& X_MO) {
  return X_MO.IsFinite() && geometry::TiltOf(X_MO.rotation) < criterion.tilt;
}

long StepsPerLook(double time_step) {
  HIRES_CHECK(time_step > 0.0, "a step of time takes no time");
  return std::max(1L, std::lround(kFallLookInterval / time_step));
}

Fall FallDetector::Update(const Pose3& X_MO, bool is_held, double t, const Pose3& X_MC) {
  now_ = {};
  if (!X_MO.IsFinite()) return Note(Fall::kLost);
  if (is_held) {
    Reset();
    now_ = {geometry::TiltOf(X_MO.rotation), 0.0, 0.0};
    return Fall::kNone;
  }
  const Pose3 X_CO = X_MC.Inverse() * X_MO;
  if (!X_CstoodO_) X_CstoodO_ = X_CO;
  now_ = DepartureFrom(*X_CstoodO_, X_CO);
  now_.tilt = geometry::TiltOf(X_MO.rotation);  // the carrier may lean
  const Fall seen = FallOf(criterion_, now_, HasLeanedLong(t));
  if (seen != Fall::kNone) return Note(seen);
  if (now_.tilt < criterion_.upright_tilt()) fall_ = Fall::kNone;  // it was put up
  return Fall::kNone;
}

bool FallDetector::HasLeanedLong(double t) {
  if (now_.tilt < criterion_.tilt) {
    leaning_since_.reset();
    return false;
  }
  if (!leaning_since_ || t < *leaning_since_) leaning_since_ = t;
  return t - *leaning_since_ >= criterion_.hold_time - kRounding;
}

Fall FallDetector::Note(Fall seen) {
  if (is_down() && !IsWorse(seen, fall_)) return Fall::kNone;
  if (!is_down()) ++falls_;
  fall_ = seen;
  return seen;
}

void FallDetector::Reset() {
  X_CstoodO_.reset();
  leaning_since_.reset();
  fall_ = Fall::kNone;
  now_ = {};
}

bool FallDetector::stands() const {
  return X_CstoodO_ && !is_down() && now_.tilt < criterion_.tilt;
}

}  // namespace hires::world
