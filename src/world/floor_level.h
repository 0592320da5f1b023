#pragma once

#include <optional>

#include "hires/world/world.h"

namespace hires::world {

/// What is so much higher or lower than a level is on it [m]: soft wheels and rounding.
constexpr double kFloorStep = 0.005;

/// A level face of something that never moves, facing up.
struct FloorFace {
  double height{0.0};    ///< [m]
  double friction{1.0};  ///< of the shape that it is part of
};

/// The highest level face, of a box or a mesh, that lies under a point within kFloorStep of it.
std::optional<FloorFace> FaceUnder(const World& world, const Eigen::Vector3d& p_M);

/// The same world with the floor on which robots stand at z = 0, where they stand higher or lower:
/// that is where the lowest areas lie, if a level face bears one of them and goes on 0.75 m around
/// it. Where such a face bears it at z = 0, its friction is the floor's.
World OnItsFloor(World world);

/// The mesh without what lies no higher than `top` [m] of the frame W: parts that lie below it as
/// a whole, and faces of open sheets. Null: nothing is left; the mesh itself where nothing is so
/// low.
std::shared_ptr<const geometry::TriangleMesh> WithoutFloor(
    const std::shared_ptr<const geometry::TriangleMesh>& mesh, const geometry::Pose3& X_WS,
    double top);

}  // namespace hires::world
