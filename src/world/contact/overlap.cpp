#include "world/contact/overlap.h"

#include <algorithm>
#include <memory>
#include <variant>

#include "geometry/mesh_pieces.h"

namespace hires::world {
namespace {

using geometry::Pose3;
using MeshOfShape = std::shared_ptr<const geometry::TriangleMesh>;

/// From above, what a shape has between two heights: of a mesh its parts and triangles, as what it
/// goes round is free.
std::vector<geometry::Polygon> OutlinesOf(const geometry::Shape& shape, const Pose3& X_MS,
                                          double z_min, double z_max) {
  if (const auto* mesh = std::get_if<MeshOfShape>(&shape))
    return geometry::MeshOutlinesInBand(**mesh, X_MS, z_min, z_max);
  const auto outline = geometry::OutlineInBand(shape, X_MS, z_min, z_max);
  return outline ? std::vector<geometry::Polygon>{*outline} : std::vector<geometry::Polygon>{};
}

/// Whether a thing as its hull reaches more than the slack into a shape.
bool ReachesInto(const geometry::Shape& thing, const Pose3& X_MT, const geometry::Shape& shape,
                 const Pose3& X_MS) {
  const geometry::Aabb bounds = geometry::BoundsOf(thing, X_MT);
  const double z_min = bounds.lower.z() + kStartSlack, z_max = bounds.upper.z() - kStartSlack;
  if (z_min > z_max || !bounds.Overlaps(geometry::BoundsOf(shape, X_MS))) return false;
  const auto outline = geometry::OutlineInBand(thing, X_MT, z_min, z_max);
  if (!outline) return false;
  const std::vector<geometry::Polygon> others = OutlinesOf(shape, X_MS, z_min, z_max);
  return std::any_of(others.begin(), others.end(), [&](const geometry::Polygon& other) {
    return geometry::Distance(*outline, other) == 0.0;
  });
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
      const bool is_round_second = is_mesh(first) && !is_mesh(second);
      if (is_round_second ? ReachesInto(second.shape, X_MS, first.shape, X_MF)
                          : ReachesInto(first.shape, X_MF, second.shape, X_MS)) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace hires::world
