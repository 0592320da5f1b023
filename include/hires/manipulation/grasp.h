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

/// [m] that grasps keep from the supporting face and the palm.
inline constexpr double kGraspClearance = 0.015;

/// Grasps of an object standing upright on its supporting face, best first: from the side at
/// several headings and heights, and from above. An object wider than the gripper opens has none.
/// Quality is the product of three shares: how near the grip is to the centre of mass (1 there, 0.5
/// at the object's height away), how deep the object is between the fingers (1 where its middle or
/// the palm is reached), and how far the gap is from both ends of the gripper's range (1 in the
/// middle, 0.5 at the ends). Deterministic.
/// @param headings  number of approach directions round the object, >= 1.
std::vector<Grasp> GraspsFor(const world::ObjectModel& object, const robot::GripperProfile& gripper,
                             int headings = 16);

}  // namespace hires::manipulation
