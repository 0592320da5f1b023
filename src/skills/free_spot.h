#pragma once

#include <string>
#include <vector>

#include "hires/geometry/polygon.h"
#include "hires/robot/observation.h"
#include "hires/skills/manipulation_params.h"
#include "hires/world/world.h"

namespace hires::skills {

/// Outline of an object seen from above, in the plane of A.
geometry::Polygon OutlineOf(const world::ObjectModel& model, const geometry::Pose3& X_AO);

/// [m] of the circle round an upright object's origin that its outline fits in.
double RadiusOf(const world::ObjectModel& model);

/// Places that an object may be put at.
struct FreeSpots {
  std::vector<Eigen::Vector3d> spots_A;  ///< best first; empty: none is free
  std::vector<std::string> occupants;    ///< names of what takes up the others, sorted
};

/// Free places on the square round the origin of A (an area's frame, z on its top), nearest to the
/// origin first: the object lies wholly within the square, `clearance` away from everything seen
/// there. Objects that stand more than 0.3 m below or above A do not count.
FreeSpots FindFreeSpots(const PlaceParams& params, const world::World& world,
                        const world::ObjectModel& object, const geometry::Pose3& X_MA,
                        const std::vector<world::ObjectState>& others);

/// The tray's places in order (middle, right, left of X_MSlot, along its y axis) that are free of
/// `others`.
FreeSpots FindFreeSlots(const PlaceParams& params, const world::World& world,
                        const world::ObjectModel& object, const geometry::Pose3& X_MSlot,
                        const std::vector<world::ObjectState>& others);

}  // namespace hires::skills
