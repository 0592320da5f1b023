#pragma once

#include <vector>

#include "hires/base/rng.h"
#include "hires/geometry/inertia.h"
#include "hires/geometry/shape.h"
#include "hires/robot/robot_profile.h"
#include "hires/simulation/variation.h"

/// What a Variation makes of nominal things.
namespace hires::simulation {

robot::BaseControllerParams Varied(robot::BaseControllerParams params, const Variation& variation);
geometry::MassProperties Varied(geometry::MassProperties properties, const Variation& variation);
std::vector<geometry::Collision> Varied(std::vector<geometry::Collision> shapes,
                                        const Variation& variation);

/// Where a link really holds an object that it holds at X_BO nominally: the grasp that led to the
/// start was a little off.
/// @param X_BL  the link in the base frame.
geometry::Pose3 VariedGrasp(const geometry::Pose3& X_BL, const geometry::Pose3& X_BO,
                            const Variation& variation);

/// Where the robot believes its base to be that is at X_MB.
geometry::Pose2 BelievedPose(const geometry::Pose2& X_MB, const Variation& variation,
                             base::Rng* rng);

}  // namespace hires::simulation
