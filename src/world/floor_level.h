#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hires/world/named_area.h"
#include "hires/world/world.h"

namespace hires::world {

/// What is so much higher or lower than a level is on it [m]: soft wheels and rounding.
constexpr double kFloorStep = 0.005;

/// A level face of something that never moves, facing up.
struct FloorFace {
  double height{0.0};    ///< [m]
  double friction{1.0};  ///< of the shape that it is part of
  std::string name;      ///< of that shape, NameOf
  double bottom{0.0};    ///< [m] of that shape
};

/// A level plane of a world's file.
struct FloorPlane {
  double height;  ///< [m]
  double friction;
  std::string where;  ///< for messages
};

/// The highest level face, of a box, an upright cylinder or a mesh, that lies under a point within
/// kFloorStep of it.
std::optional<FloorFace> FaceUnder(const World& world, const Eigen::Vector3d& p_M);

/// The same world with the floor on which robots stand at z = 0, where they stand higher or lower:
/// that is where the lowest areas lie, if a level face bears one of them and goes on 0.75 m to all
/// sides of it, or 3 m to one; areas below z = 0 that nothing bears do not count. Where such a face
/// bears it at z = 0, its friction is the floor's. A floor of such faces ends where they do: below
/// it lies the plane z = 0 of the file, or the one that is implied there where the shape does not
/// reach down to it, else nothing (World::ground_depth).
/// @param has_plane  the file has a plane z = 0.
World OnItsFloor(World world, bool has_plane = false);

/// The same where the file's highest plane is `plane`, at whatever height: what stands on it stands
/// at z = 0 first.
/// @param areas  that are added to those of the world. They stand on the floor that its own say;
/// where these say none, on z = 0, or, where a slab lies there, on its top, if that is a level face
/// that goes on as above with 0.3 m of room above it. With a height of its own an area stands on
/// the nearest of such faces, or z = 0.
/// @throws base::ConfigError as AddAreas.
World OnItsFloor(World world, const std::optional<FloorPlane>& plane,
                 const std::vector<NamedArea>& areas = {});

/// The mesh without what lies no higher than `top` [m] of the frame W: parts that lie below it as
/// a whole, and faces of open sheets. Null: nothing is left; the mesh itself where nothing is so
/// low.
std::shared_ptr<const geometry::TriangleMesh> WithoutFloor(
    const std::shared_ptr<const geometry::TriangleMesh>& mesh, const geometry::Pose3& X_WS,
    double top);

}  // namespace hires::world
