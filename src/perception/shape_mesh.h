#pragma once

#include <vector>

#include "hires/geometry/shape.h"
#include "hires/perception/surroundings.h"

namespace hires::perception {

constexpr int kRoundSides = 64;  ///< of the prisms and globes that stand for round shapes

/// Box of edge 1, cylinder of radius 1 and length 1, sphere of radius 1, centred, as triangles that
/// are counter-clockwise seen from outside.
geometry::TriangleMesh UnitBoxMesh();
geometry::TriangleMesh UnitCylinderMesh();
geometry::TriangleMesh UnitSphereMesh();

/// What turns the unit mesh of a shape into the shape; ones for a mesh.
Eigen::Vector3d ScaleOf(const geometry::Shape& shape);

/// A fixed pattern of points on the hull of a body that is made of these shapes.
std::vector<SurfacePoint> SurfacePattern(const std::vector<geometry::Collision>& collisions_O);

}  // namespace hires::perception
