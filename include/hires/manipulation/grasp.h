#pragma once

#include <string>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/robot/upper_body.h"
#include "hires/world/world.h"

namespace hires::manipulation {

/// One way to take an upright object between the fingers.
struct Grasp {
  std::string kind;       ///< "side" or "top"
  geometry::Pose3 X_OT;   ///< tool in the object's frame, fingers round the object
  double approach{0.10};  ///< [m] back along the tool's x axis where the straight way begins
  double gap{0.0};        ///< [m] between the finger tips when they touch
  double quality{0.0};    ///< 0..1, for sorting: see GraspsFor
};

/// Grasps of an object standing upright on its supporting face, best first: from the side at
/// several headings and heights, and from above. An object wider than the gripper opens has none.
/// Quality prefers a grip near the centre of mass, deep between the fingers, and a gap well inside
/// the gripper's range. Deterministic.
/// @param headings  number of approach directions round the object.
std::vector<Grasp> GraspsFor(const world::ObjectModel& object, const robot::GripperProfile& gripper,
                             int headings = 16);

}  // namespace hires::manipulation
