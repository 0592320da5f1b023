#include "hires/control/override_watch.h"

#include <cmath>

namespace hires::control {

using geometry::Twist2;

void OverrideWatch::See(double now, const Twist2& V_B) {
  if (!commanded_ || !Differs(V_B)) {
    since_.reset();
    is_overridden_ = false;
    return;
  }
  if (!since_ || now < *since_) since_ = now;
  is_overridden_ = now - *since_ > params_.after;
}

bool OverrideWatch::Differs(const Twist2& V_B) const {
  return std::hypot(V_B.vx - commanded_->vx, V_B.vy - commanded_->vy) > params_.linear ||
         std::abs(V_B.wz - commanded_->wz) > params_.angular;
}

void OverrideWatch::Forget() {
  commanded_.reset();
  since_.reset();
  is_overridden_ = false;
}

}  // namespace hires::control
