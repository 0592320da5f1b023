#pragma once

#include <Eigen/Core>
#include <string>

#include "hires/geometry/shape.h"

namespace hires::geometry {

/// A part of a mesh file, by the name of its node, object or geometry; "" is the whole file.
struct Submesh {
  std::string name;
  bool is_centred{false};  ///< move it so that the middle of its bounds is its origin
};

/// Reads the triangles of a mesh file (.stl, .dae, .obj, or glTF 2 as .glb or .gltf; case of the
/// ending ignored) with Assimp.
/// A Collada file's length unit is honoured, its up-axis is not: z is up, as everywhere in ROS. Nor
/// is glTF turned, whose unit is the metre and whose y is up by its standard: its x, y and z, with
/// its nodes' rotations, are those of the link, as in Gazebo (gz-common's AssimpLoader), which most
/// that is given here was made for. Newer RViz of ROS 2 and Drake turn y up to z up; a mesh that
/// was placed for them wants rpy="1.5708 0 0" more.
/// Polygons are split into triangles, equal corners are joined, triangles without an area dropped.
/// Only this one file is opened: materials and textures that it names are not looked for.
/// @param path   Where the file lies.
/// @param scale  Factor per axis; a negative one mirrors, and triangles then turn so that they stay
///               counter-clockwise seen from outside.
/// @param submesh  What of it is read; its bounds are those before scaling.
/// @throws base::ConfigError naming the path: missing, another format, malformed, glTF whose
/// corners are compressed or in another file, no triangles, no such submesh (with the names that
/// there are), more than 64 MB or 500,000 triangles, a coordinate that is not finite or beyond 10
/// km, a scale that is zero or not finite.
TriangleMesh ReadMesh(const std::string& path,
                      const Eigen::Vector3d& scale = Eigen::Vector3d::Ones(),
                      const Submesh& submesh = {});

}  // namespace hires::geometry
