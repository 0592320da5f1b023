#pragma once

#include <array>
#include <vector>

#include "hires/geometry/shape.h"

namespace hires::geometry {

/// The parts of a mesh that hang together (share corners), each a mesh of its own, in the order of
/// their first triangle. A closed surface that faces inwards, within a solid part, is that part's
/// cavity (a room in a building that has no door, say): both are one part, which is not solid.
std::vector<TriangleMesh> ConnectedParts(const TriangleMesh& mesh);

/// Does every corner lie on or behind the plane of every triangle? Corners may stand out by `slack`
/// [m]. Parts too large to be tested cheaply count as not convex.
bool IsConvex(const TriangleMesh& mesh, double slack = 1e-6);

/// Whether a part is closed (every edge belongs to two triangles, which run along it in opposite
/// directions) and convex: then what it encloses is matter. Sheets and walls that go round a room
/// are not.
bool IsSolid(const TriangleMesh& mesh);

/// A triangle of the mesh as a prism of 1 mm, so that it has an outline also when it stands
/// upright.
Shape ThickTriangle(const TriangleMesh& mesh, const std::array<int, 3>& triangle);

/// Six times the signed volume [m^3] between the surface and a point, which does not matter of a
/// closed one: negative where triangles face inwards.
double SixfoldVolume(const TriangleMesh& mesh, const Eigen::Vector3d& p_M);

/// How often the surface goes round a point, its triangles counter-clockwise from outside: 1 within
/// a closed one, 0 outside and within its cavities, in between where it has holes (van Oosterom and
/// Strackee, The solid angle of a plane triangle, IEEE Trans. Biomed. Eng. 30(2), 1983).
double WindingNumber(const TriangleMesh& mesh, const Eigen::Vector3d& p_M);

/// Outlines of a mesh within z_min..z_max that keep its hollows open: a solid part gives its
/// outline; of other parts each triangle gives one, thickened to 1 mm.
std::vector<Polygon> MeshOutlinesInBand(const TriangleMesh& mesh, const Pose3& X_WS, double z_min,
                                        double z_max);

}  // namespace hires::geometry
