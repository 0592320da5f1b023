#pragma once

#include <string>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/geometry/shape.h"
#include "hires/world/world.h"

namespace hires::lab {

/// A world at the start of a run, and where the robot stands in it.
struct WorldAtStart {
  const world::World& world;
  geometry::Pose2 X_MB;
};

/// Two that touch, or stand in each other.
struct Overlap {
  std::string thing;  ///< furniture that was moved, or the robot
  std::string other;  ///< "restaurant_walls"
};

/// What a variation put into each other: furniture that it moved, with other static bodies, and the
/// robot with any; those that touch each other in the original, too, are left out. Shapes count as
/// in simulation::RobotClearance.
/// @param robot, robot_shapes_B  its name, and its shapes as its joints are at the start.
std::vector<Overlap> NewOverlaps(const WorldAtStart& original, const WorldAtStart& varied,
                                 const std::string& robot,
                                 const std::vector<geometry::Collision>& robot_shapes_B);

}  // namespace hires::lab
