#pragma once

#include <Eigen/Core>
#include <string>

#include "hires/geometry/shape.h"

namespace hires::geometry {

/// Reads the triangles of a mesh file (.stl, .dae or .obj; case of the ending ignored) with Assimp.
/// A Collada file's length unit is honoured, its up-axis is not: z is up, as everywhere in ROS.
/// Polygons are split into triangles, equal corners are joined, triangles without an area dropped.
/// Only this one file is opened: materials and textures that it names are not looked for.
/// @param path   Where the file lies.
/// @param scale  Factor per axis; a negative one mirrors, and triangles then turn so that they stay
///               counter-clockwise seen from outside.
/// @throws base::ConfigError naming the path: missing, another format, malformed, no triangles,
/// more than 64 MB or 2 million triangles, a coordinate that is not finite or beyond 10 km, a scale
/// that is zero or not finite.
TriangleMesh ReadMesh(const std::string& path,
                      const Eigen::Vector3d& scale = Eigen::Vector3d::Ones());

}  // namespace hires::geometry
