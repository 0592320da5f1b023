#include "imagination/physics_hash.h"

#include "hires/base/hash.h"

namespace hires::imagination {
namespace {

/// Of the simulator: raised whenever the same calls give other results.
constexpr double kPhysicsVersion = 2.0;

}  // namespace

std::uint64_t PhysicsHash(const physics::PhysicsParams& physics, const RolloutParams& rollout,
                          const world::StandingCriterion& standing) {
  base::Hasher hasher;
  const auto add = [&hasher](std::initializer_list<double> values) {
    for (const double value : values) hasher.Add(value);
  };
  hasher.Add(kPhysicsVersion);
  // All members by name: one that is added to a struct and not here does not compile.
  const auto& [time_step, gravity, erp, cfm, surface_layer, max_correcting_velocity,
               restitution_threshold] = physics;
  add({time_step, gravity, erp, cfm, surface_layer, max_correcting_velocity,
       restitution_threshold});
  const auto& [settling_time, time_limit, sample_period, shaking_tilt, topple_tilt, aftermath,
               put_back, put_back_tilt] = rollout;
  add({settling_time, time_limit, sample_period, shaking_tilt, topple_tilt, aftermath,
       put_back ? 1.0 : 0.0, put_back_tilt});
  const auto& [tilt, hold_time, drop, slide] = standing;
  add({tilt, hold_time, drop, slide});
  return hasher.value();
}

}  // namespace hires::imagination
