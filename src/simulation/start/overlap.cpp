#include "simulation/start/overlap.h"

#include <algorithm>
#include <array>
#include <memory>
#include <variant>

#include "geometry/mesh_pieces.h"

namespace hires::simulation {
namespace {

using geometry::Pose3;
using MeshOfShape = std::shared_ptr<const geometry::TriangleMesh>;

constexpr double kMatter = 0.99;  // of a winding number: within a closed surface

/// Whether a triangle of the mesh crosses the prism, or the prism's middle lies in what a closed
/// surface of it holds; what a mesh merely goes round is free.
bool MeshMeets(const geometry::TriangleMesh& mesh, const Pose3& X_MS,
               const geometry::Polygon& outline, const geometry::Aabb& bounds) {
  const Pose3 X_SM = X_MS.Inverse();
  const Eigen::Vector3d middle = 0.5 * (bounds.lower + bounds.upper);
  const geometry::Aabb near =
      geometry::BoundsOf(geometry::Box{bounds.upper - bounds.lower},
                         X_SM * Pose3{middle, Eigen::Quaterniond::Identity()});
  const auto crosses = [&](const std::array<int, 3>& triangle) {
    geometry::Aabb of_triangle;
    for (const int corner : triangle) of_triangle.Include(mesh.vertices[corner]);
    if (!of_triangle.Overlaps(near)) return false;
    const auto other = geometry::OutlineInBand(geometry::ThickTriangle(mesh, triangle), X_MS,
                                               bounds.lower.z(), bounds.upper.z());
    return other && geometry::Distance(outline, *other) == 0.0;
  };
  if (std::any_of(mesh.triangles.begin(), mesh.triangles.end(), crosses)) return true;
  return geometry::WindingNumber(mesh, X_SM * middle) > kMatter;
}

/// Whether a thing as its hull reaches more than the slack into a shape.
bool ReachesInto(const geometry::Shape& thing, const Pose3& X_MT, const geometry::Shape& shape,
                 const Pose3& X_MS) {
  geometry::Aabb bounds = geometry::BoundsOf(thing, X_MT);
  if (!bounds.Overlaps(geometry::BoundsOf(shape, X_MS))) return false;
  bounds.lower.z() += kStartSlack;
  bounds.upper.z() -= kStartSlack;
  if (bounds.lower.z() > bounds.upper.z()) return false;
  const auto outline = geometry::OutlineInBand(thing, X_MT, bounds.lower.z(), bounds.upper.z());
  if (!outline) return false;
  if (const auto* mesh = std::get_if<MeshOfShape>(&shape))
    return MeshMeets(**mesh, X_MS, *outline, bounds);
  const auto other = geometry::OutlineInBand(shape, X_MS, bounds.lower.z(), bounds.upper.z());
  return other && geometry::Distance(*outline, *other) == 0.0;
}

}  // namespace

bool Overlap(const std::vector<geometry::Collision>& a, const Pose3& X_MA,
             const std::vector<geometry::Collision>& b, const Pose3& X_MB) {
  const auto is_mesh = [](const geometry::Collision& shape) {
    return std::holds_alternative<MeshOfShape>(shape.shape);
  };
  for (const geometry::Collision& first : a) {
    const Pose3 X_MF = X_MA * first.X_BS;
    for (const geometry::Collision& second : b) {
      const Pose3 X_MS = X_MB * second.X_BS;
      // A mesh is judged by its triangles: of two each is the hull once, as one may go round the
      // other.
      const bool is_in_second = (is_mesh(first) && !is_mesh(second)) ||
                                ReachesInto(first.shape, X_MF, second.shape, X_MS);
      if (is_in_second && (!is_mesh(first) || ReachesInto(second.shape, X_MS, first.shape, X_MF)))
        return true;
    }
  }
  return false;
}

}  // namespace hires::simulation
