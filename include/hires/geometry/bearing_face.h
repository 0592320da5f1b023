#pragma once

#include "hires/geometry/pose.h"
#include "hires/geometry/shape.h"

namespace hires::geometry {

/// Bounds of a shape up to the face that things stand on. Of a mesh that is its largest level face,
/// as of a basket its floor and not its rim; of several that are nearly as large (0.8) the highest.
/// Where no level face has a tenth of what the shape covers from above, and of all other shapes,
/// the whole bounds.
Aabb BearingBounds(const Shape& shape, const Pose3& X_WS);

/// Whether a face of the mesh that is less than 45 degrees steep lies under or over the point, at
/// most `gap` [m] away.
bool HasFaceAt(const TriangleMesh& mesh, const Pose3& X_WM, const Eigen::Vector3d& p_W, double gap);

}  // namespace hires::geometry
