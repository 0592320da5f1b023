#include <cmath>
#include <utility>

#include "hires/simulation/self_localisation.h"
#include "simulation/self_localisation/streams.h"

namespace hires::simulation {

using geometry::Pose2;

MotionSensors::MotionSensors(std::shared_ptr<const SelfLocalisationParams> params,
                             const Pose2& X_MB, const base::Rng& rng)
    : params_(std::move(params)),
      gyro_rng_(rng.Fork(place_stream::kGyro)),
      wheels_(params_->casters, rng.Fork(place_stream::kWheels)),
      X_MBtrue_(X_MB),
      bias_(gyro_rng_.Normal(0.0, params_->gyro.bias)),
      floor_rng_(rng.Fork(place_stream::kFloor)) {}

/// A motion as the wheels make it: on a wet patch they spin.
Pose2 MotionSensors::Spun(const Pose2& X_AB) {
  const WetPatch* under = nullptr;
  for (const WetPatch& patch : params_->wet)
    if ((X_MBtrue_.position() - patch.at_M).norm() <= patch.radius) under = &patch;
  if (under != nullptr && !is_on_wet_) spin_ = floor_rng_.Normal(0.0, under->spin);
  is_on_wet_ = under != nullptr;
  if (!is_on_wet_) return X_AB;
  return {(1.0 + spin_) * X_AB.x, (1.0 + spin_) * X_AB.y, (1.0 + spin_) * X_AB.yaw};
}

void MotionSensors::Drive(double dt, const Pose2& X_MB) {
  const Pose2 X_AB = X_MBtrue_.Inverse() * X_MB;
  X_MBtrue_ = X_MB;
  const Pose2 rolled = Spun(X_AB);
  wheels_.Roll(rolled);
  const double root = std::sqrt(dt);
  const double turned = X_AB.yaw + bias_ * dt + gyro_rng_.Normal(0.0, params_->gyro.walk * root);
  bias_ += gyro_rng_.Normal(0.0, params_->gyro.bias_walk * root);
  inertia_ = {inertia_.yaw + turned, turned / dt};
  odometry_ = {wheels_.X_OB(), {rolled.x / dt, rolled.y / dt, turned / dt}};
}

}  // namespace hires::simulation
