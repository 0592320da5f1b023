#pragma once

#include "hires/geometry/shape.h"
#include "perception/ray_scene.h"

namespace hires::perception {

/// How far a point is from a mesh [m], exact up to single precision where it is below `limit`, else
/// `limit`; 0 within a closed mesh.
/// @param scene  of the mesh alone (MeshLibrary).
float DistanceToMesh(RTCScene scene, const geometry::TriangleMesh& mesh, const Eigen::Vector3f& p,
                     float limit);

}  // namespace hires::perception
