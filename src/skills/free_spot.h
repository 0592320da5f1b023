#pragma once

#include <Eigen/Geometry>
#include <optional>
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

/// [m] What is farther above or below a support stands somewhere else.
constexpr double kSameLevel = 0.30;

/// Places that an object may be put at.
struct FreeSpots {
  std::vector<Eigen::Vector3d> spots_A;  ///< best first; empty: none is free
  std::vector<std::string> occupants;    ///< names of what takes up the others, sorted
};

/// Where things can be put: a frame with z on a top, and how far the place goes round it.
struct PlacingArea {
  geometry::Pose3 X_MA;
  Eigen::AlignedBox2d extent_A;  ///< [m] without its edges
};
/// @throws base::ConfigError for an area that the world does not have, with names like it.
PlacingArea AreaIn(const world::World& world, const std::string& area, const PlaceParams& params);

/// Free places of an area, nearest to its origin first: the object lies wholly within the extent,
/// `clearance` away from everything seen there. Objects that stand more than kSameLevel below or
/// above A do not count.
FreeSpots FindFreeSpots(const PlaceParams& params, const world::World& world,
                        const world::ObjectModel& object, const PlacingArea& area,
                        const std::vector<world::ObjectState>& others);

/// Any free place of an area will do, the nearest to its middle first.
constexpr char kAnySpot[] = "any";

/// Names of the spots that every area has: "middle", and one at each edge and corner, by the axes
/// of the area's frame: "front" (+x), "back", "left" (+y), "right", "front_left", ... The choice is
/// one of names, as plans and the Blackboard know no metres, and the same on the robot as in a
/// rollout.
std::vector<std::string> SpotNames();

/// Where a spot lies in the area's frame, each coordinate -1, 0 or 1 times as far from the middle
/// as the object may go; nothing for kAnySpot.
/// @throws base::ConfigError naming what came, with names like it.
std::optional<Eigen::Vector2d> ParseSpot(const std::string& name);

/// That spot, if it is free as FindFreeSpots means it; the object at the edge lies just within the
/// extent.
FreeSpots FindStatedSpot(const PlaceParams& params, const world::World& world,
                         const world::ObjectModel& object, const PlacingArea& area,
                         const std::vector<world::ObjectState>& others,
                         const Eigen::Vector2d& spot);

/// The tray's places in order (middle, right, left of X_MSlot, along its y axis) that are free of
/// `others`.
FreeSpots FindFreeSlots(const PlaceParams& params, const world::World& world,
                        const world::ObjectModel& object, const geometry::Pose3& X_MSlot,
                        const std::vector<world::ObjectState>& others);

}  // namespace hires::skills
