#pragma once

#include <string>
#include <vector>

#include "hires/manipulation/grasp.h"
#include "skills/arm_planner.h"
#include "skills/free_spot.h"

namespace hires::skills {

/// A grasp thought through, from where the arm is to the lifted object.
struct GraspPlan {
  base::Failure failure;  ///< why there is none; nothing: there is
  manipulation::Grasp grasp;
  JointPath reach;     ///< to where the straight way begins
  JointPath approach;  ///< straight to the object
  JointPath lift;      ///< straight up with it
};

/// The best grasp that can be carried out: grasps in the order of their quality, those from the
/// arm's own side first, of which the first `max_grasps` that leave the object upright in the arm's
/// posture beside the body are tried. Fails as the grasp that came farthest.
/// @param object  upright; its pose replaces the one in `observation`.
GraspPlan PlanGrasp(const ManipulationContext& context, const std::string& arm,
                    const robot::Observation& observation, const world::ObjectState& object,
                    std::uint64_t seed);

/// Putting down thought through, from where the arm is to the open hand beside the object.
struct PlacePlan {
  base::Failure failure;  ///< why there is none; nothing: there is
  geometry::Pose3 X_BO;   ///< where the object will stand, in the base frame
  JointPath reach;        ///< to over the spot
  JointPath lower;        ///< straight down
  JointPath retreat;      ///< straight back with the hand open
};

/// The first spot and heading of the object that can be carried out; headings that have the hand
/// point away from the shoulder first. If everything that is in the way is an object on the area,
/// the failure is area_occupied by them.
/// @param held  what the arm holds, as observed.  @param X_MA  frame of the spots.
PlacePlan PlanPlacing(const ManipulationContext& context, const std::string& arm,
                      const robot::Observation& observation, const robot::SeenObject& held,
                      const geometry::Pose3& X_MA, const FreeSpots& spots, std::uint64_t seed);

}  // namespace hires::skills
