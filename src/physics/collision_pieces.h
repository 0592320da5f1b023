#pragma once

#include <vector>

#include "hires/geometry/shape.h"

namespace hires::physics {

/// The shape as contacts are found best: a mesh that is no polytope as its solid parts, its flat
/// convex faces and what is left (geometry::ConvexPiecesOf); others as they are. On a mesh as a
/// whole ODE lets things stand that tip on the same faces of a box. Meshes of more than 20,000
/// triangles stay whole. What was found of a mesh is kept while the mesh lives.
/// @throws base::ConfigError of a mesh as RequireShape.
std::vector<geometry::Collision> PiecesOf(const geometry::Collision& collision);

}  // namespace hires::physics
