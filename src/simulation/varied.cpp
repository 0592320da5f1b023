#include "simulation/varied.h"

#include <variant>

namespace hires::simulation {

using geometry::Pose2;
using geometry::Pose3;

robot::BaseControllerParams Varied(robot::BaseControllerParams params, const Variation& variation) {
  params.command_lag += variation.command_delay;
  params.loop_damping *= variation.loop_damping_factor;
  if (params.casters) params.casters->wheel_damping *= variation.wheel_damping_factor;
  params.sway_compliance *= variation.sway_factor;
  return params;
}

geometry::MassProperties Varied(geometry::MassProperties properties, const Variation& variation) {
  properties.mass *= variation.mass_factor;
  properties.I_BBcm *= variation.mass_factor;
  properties.p_BBcm.z() *= variation.com_height_factor;
  properties.p_BBcm.head<2>() += variation.com_offset;
  return properties;
}

std::vector<geometry::Collision> Varied(std::vector<geometry::Collision> shapes,
                                        const Variation& variation) {
  for (geometry::Collision& shape : shapes) {
    shape.friction *= variation.friction_factor;
    if (auto* cylinder = std::get_if<geometry::Cylinder>(&shape.shape)) {
      cylinder->radius *= variation.radius_factor;
    }
  }
  return shapes;
}

Pose3 VariedGrasp(const Pose3& X_BL, const Pose3& X_BO, const Variation& variation) {
  if (variation.grasp_offset.isZero(0.0) && variation.grasp_turn == 0.0) return X_BO;
  Pose3 X_LO = X_BL.Inverse() * X_BO;
  X_LO.translation.x() += variation.grasp_offset.x();
  X_LO.translation.z() += variation.grasp_offset.y();
  X_LO.rotation = geometry::RotationFromRpy(0.0, variation.grasp_turn, 0.0) * X_LO.rotation;
  return X_BL * X_LO;
}

Pose2 BelievedPose(const Pose2& X_MB, const Variation& variation, base::Rng* rng) {
  const Pose2 noise{rng->Normal(0.0, variation.localisation_noise),
                    rng->Normal(0.0, variation.localisation_noise),
                    rng->Normal(0.0, variation.localisation_noise_yaw)};
  return X_MB * variation.localisation_bias * noise;
}

}  // namespace hires::simulation
