#include "geometry/mesh_pieces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "hires/geometry/angles.h"

namespace hires::geometry {
namespace {

constexpr double kThickness = 1e-3;                    // [m] of a lone triangle
constexpr std::size_t kMaxConvexityTests = 4'000'000;  // triangles times corners

/// Which corners hang together: union-find with path halving.
class Groups {
 public:
  explicit Groups(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int Find(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void Join(int a, int b) { parent_[Find(a)] = Find(b); }

 private:
  std::vector<int> parent_;
};

Eigen::Vector3d NormalOf(const TriangleMesh& mesh, const std::array<int, 3>& triangle) {
  const Eigen::Vector3d& a = mesh.vertices[triangle[0]];
  return (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a).normalized();
}

/// Collects triangles and renumbers their corners.
class PartBuilder {
 public:
  void Add(const TriangleMesh& from, const std::array<int, 3>& triangle) {
    std::array<int, 3> renumbered;
    for (int k = 0; k < 3; ++k) renumbered[k] = NumberOf(from, triangle[k]);
    part_.triangles.push_back(renumbered);
  }
  TriangleMesh Take() { return std::move(part_); }

 private:
  int NumberOf(const TriangleMesh& from, int corner) {
    const auto [entry, is_new] = numbers_.emplace(corner, static_cast<int>(part_.vertices.size()));
    if (is_new) part_.vertices.push_back(from.vertices[corner]);
    return entry->second;
  }

  TriangleMesh part_;
  std::map<int, int> numbers_;
};

void AppendOutline(const Shape& shape, const Pose3& X_WS, double z_min, double z_max,
                   std::vector<Polygon>* outlines) {
  auto outline = OutlineInBand(shape, X_WS, z_min, z_max);
  if (outline) outlines->push_back(std::move(*outline));
}

/// The parts that share corners, in the order of their first triangle.
std::vector<TriangleMesh> PartsOf(const TriangleMesh& mesh, Groups* groups) {
  std::map<int, std::size_t> index_of_group;
  std::vector<PartBuilder> builders;
  for (const auto& triangle : mesh.triangles) {
    const auto [entry, is_new] = index_of_group.emplace(groups->Find(triangle[0]), builders.size());
    if (is_new) builders.emplace_back();
    builders[entry->second].Add(mesh, triangle);
  }
  std::vector<TriangleMesh> parts;
  for (PartBuilder& builder : builders) parts.push_back(builder.Take());
  return parts;
}

bool IsClosed(const TriangleMesh& mesh) {
  std::set<std::pair<int, int>> edges;
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) edges.insert({t[k], t[(k + 1) % 3]});
  }
  return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
    return edges.count({edge.second, edge.first}) > 0;
  });
}

/// @pre `around` is solid.
bool IsWithin(const TriangleMesh& part, const TriangleMesh& around) {
  return std::all_of(
      around.triangles.begin(), around.triangles.end(), [&](const std::array<int, 3>& triangle) {
        const Eigen::Vector3d normal = NormalOf(around, triangle);
        const double height = normal.dot(around.vertices[triangle[0]]);
        return std::all_of(
            part.vertices.begin(), part.vertices.end(),
            [&](const Eigen::Vector3d& corner) { return normal.dot(corner) <= height; });
      });
}

Aabb BoundsOfPart(const TriangleMesh& part) {
  Aabb bounds;
  for (const Eigen::Vector3d& p : part.vertices) bounds.Include(p);
  return bounds;
}

bool Holds(const Aabb& around, const Aabb& bounds) {
  return (around.lower.array() <= bounds.lower.array()).all() &&
         (around.upper.array() >= bounds.upper.array()).all();
}

/// A part whose faces look inwards, and one round it.
using Cavity = std::pair<std::size_t, std::size_t>;

/// Meshes may have a hundred thousand parts: along the longest axis, each hollow one is compared
/// with those alone that are beside it there, by their boxes first.
std::vector<Cavity> CavitiesIn(const std::vector<TriangleMesh>& parts) {
  std::vector<Aabb> bounds;
  std::vector<char> is_hollow;
  Aabb all;
  for (const TriangleMesh& part : parts) {
    bounds.push_back(BoundsOfPart(part));
    is_hollow.push_back(SixfoldVolume(part, part.vertices.front()) < 0.0 && IsClosed(part) ? 1 : 0);
    all.Include(bounds.back());
  }
  if (std::count(is_hollow.begin(), is_hollow.end(), 1) == 0) return {};
  int axis = 0;
  (all.upper - all.lower).maxCoeff(&axis);
  std::vector<std::size_t> by_begin(parts.size());
  std::iota(by_begin.begin(), by_begin.end(), std::size_t{0});
  // Of two that begin together the longer one first: it may be round the other.
  std::sort(by_begin.begin(), by_begin.end(), [&](std::size_t a, std::size_t b) {
    return std::make_tuple(bounds[a].lower[axis], -bounds[a].upper[axis], is_hollow[a], a) <
           std::make_tuple(bounds[b].lower[axis], -bounds[b].upper[axis], is_hollow[b], b);
  });
  std::vector<Cavity> cavities;
  std::vector<std::size_t> around;  // solid ones that have not ended
  for (const std::size_t i : by_begin) {
    if (!is_hollow[i]) {
      if (IsSolid(parts[i])) around.push_back(i);
      continue;
    }
    const auto has_ended = [&](std::size_t k) {
      return bounds[k].upper[axis] < bounds[i].lower[axis];
    };
    around.erase(std::remove_if(around.begin(), around.end(), has_ended), around.end());
    for (const std::size_t k : around) {
      if (Holds(bounds[k], bounds[i]) && IsWithin(parts[i], parts[k])) cavities.emplace_back(i, k);
    }
  }
  std::sort(cavities.begin(), cavities.end());
  return cavities;
}

}  // namespace

std::vector<TriangleMesh> ConnectedParts(const TriangleMesh& mesh) {
  Groups groups(mesh.vertices.size());
  std::vector<int> corner_of;  // of the part with that index, one in the mesh
  for (const auto& triangle : mesh.triangles) {
    groups.Join(triangle[0], triangle[1]);
    groups.Join(triangle[1], triangle[2]);
  }
  std::set<int> seen;
  for (const auto& triangle : mesh.triangles) {
    if (seen.insert(groups.Find(triangle[0])).second) corner_of.push_back(triangle[0]);
  }
  std::vector<TriangleMesh> parts = PartsOf(mesh, &groups);
  const std::vector<Cavity> cavities = CavitiesIn(parts);
  for (const auto& [hollow, around] : cavities) groups.Join(corner_of[hollow], corner_of[around]);
  return cavities.empty() ? parts : PartsOf(mesh, &groups);
}

bool IsConvex(const TriangleMesh& mesh, double slack) {
  if (mesh.triangles.size() * mesh.vertices.size() > kMaxConvexityTests) return false;
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3d normal = NormalOf(mesh, triangle);
    const double height = normal.dot(mesh.vertices[triangle[0]]);
    for (const Eigen::Vector3d& corner : mesh.vertices) {
      if (normal.dot(corner) > height + slack) return false;
    }
  }
  return true;
}

bool IsSolid(const TriangleMesh& mesh) { return IsClosed(mesh) && IsConvex(mesh); }

Shape ThickTriangle(const TriangleMesh& mesh, const std::array<int, 3>& triangle) {
  const Eigen::Vector3d half = NormalOf(mesh, triangle) * kThickness / 2.0;
  auto prism = std::make_shared<TriangleMesh>();
  for (const double side : {-1.0, 1.0}) {
    for (const int corner : triangle) {
      prism->vertices.push_back(mesh.vertices[corner] + side * half);
    }
  }
  prism->triangles = {{2, 1, 0}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3},
                      {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  return std::shared_ptr<const TriangleMesh>(std::move(prism));
}

double SixfoldVolume(const TriangleMesh& mesh, const Eigen::Vector3d& p_M) {
  double sum = 0.0;
  for (const auto& t : mesh.triangles) {
    sum += (mesh.vertices[t[0]] - p_M)
               .dot((mesh.vertices[t[1]] - p_M).cross(mesh.vertices[t[2]] - p_M));
  }
  return sum;
}

double WindingNumber(const TriangleMesh& mesh, const Eigen::Vector3d& p_M) {
  double halves = 0.0;  // [rad] half the solid angle
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[triangle[0]] - p_M,
                          b = mesh.vertices[triangle[1]] - p_M,
                          c = mesh.vertices[triangle[2]] - p_M;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    halves +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return halves / (2.0 * kPi);
}

std::vector<Polygon> MeshOutlinesInBand(const TriangleMesh& mesh, const Pose3& X_WS, double z_min,
                                        double z_max) {
  std::vector<Polygon> outlines;
  for (TriangleMesh& part : ConnectedParts(mesh)) {
    if (IsSolid(part)) {
      const auto shared = std::make_shared<const TriangleMesh>(std::move(part));
      AppendOutline(shared, X_WS, z_min, z_max, &outlines);
      continue;
    }
    for (const auto& triangle : part.triangles) {
      AppendOutline(ThickTriangle(part, triangle), X_WS, z_min, z_max, &outlines);
    }
  }
  return outlines;
}

}  // namespace hires::geometry
