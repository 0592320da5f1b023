#include "physics/collision_pieces.h"

#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <variant>

#include "geometry/convex_pieces.h"
#include "physics/placed_shape.h"
#include "physics/polytope.h"

namespace hires::physics {
namespace {

using Mesh = std::shared_ptr<const geometry::TriangleMesh>;

constexpr std::size_t kMostTriangles = 20'000;

std::vector<Mesh> CutUp(const geometry::TriangleMesh& mesh) {
  if (mesh.triangles.size() > kMostTriangles || PolytopeOf(mesh)) return {};
  geometry::ConvexPieces pieces = geometry::ConvexPiecesOf(mesh);
  if (pieces.solids.empty()) return {};
  if (pieces.rest) pieces.solids.push_back(std::move(pieces.rest));
  return std::move(pieces.solids);
}

/// Worlds of one scene are made by the hundred, of the same meshes.
class KnownPieces {
 public:
  /// @param collision  whose shape the mesh is.  @throws base::ConfigError as RequireShape.
  std::vector<Mesh> Of(const Mesh& mesh, const geometry::Collision& collision) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto known = pieces_.find(mesh.get());
    if (known != pieces_.end() && known->second.first.lock() == mesh) return known->second.second;
    RequireShape(collision);
    for (auto it = pieces_.begin(); it != pieces_.end();)
      it = it->second.first.expired() ? pieces_.erase(it) : std::next(it);
    std::vector<Mesh> pieces = CutUp(*mesh);
    pieces_[mesh.get()] = {mesh, pieces};
    return pieces;
  }

 private:
  std::mutex mutex_;
  std::map<const geometry::TriangleMesh*,
           std::pair<std::weak_ptr<const geometry::TriangleMesh>, std::vector<Mesh>>>
      pieces_;
};

}  // namespace

std::vector<geometry::Collision> PiecesOf(const geometry::Collision& collision) {
  static KnownPieces known;
  const auto* mesh = std::get_if<Mesh>(&collision.shape);
  if (mesh == nullptr) return {collision};
  const std::vector<Mesh> pieces = known.Of(*mesh, collision);
  if (pieces.empty()) return {collision};
  std::vector<geometry::Collision> collisions;
  for (const Mesh& piece : pieces) {
    collisions.push_back(collision);
    collisions.back().shape = piece;
  }
  return collisions;
}

}  // namespace hires::physics
