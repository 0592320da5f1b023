#include "world/floor_level.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "hires/base/log.h"
#include "world/mesh_pieces.h"

namespace hires::world {
namespace {

using Mesh = std::shared_ptr<const geometry::TriangleMesh>;

constexpr double kLevel = 1e-3;  // [rad] that a level face may be tilted

bool IsInside(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
              const Eigen::Vector2d& c) {
  const auto side = [&p](const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    const Eigen::Vector2d along = to - from, off = p - from;
    return along.x() * off.y() - along.y() * off.x();
  };
  return side(a, b) >= 0.0 && side(b, c) >= 0.0 && side(c, a) >= 0.0;
}

/// Heights of the level faces of a shape above or below x, y of a point.
std::vector<double> LevelFaces(const geometry::Shape& shape, const geometry::Pose3& X_MS,
                               const Eigen::Vector3d& p_M) {
  std::vector<double> heights;
  if (const auto* box = std::get_if<geometry::Box>(&shape)) {
    const Eigen::Matrix3d R = X_MS.rotation.toRotationMatrix();
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(R(2, axis)) < std::cos(kLevel)) continue;
      const Eigen::Vector3d p_S = X_MS.Inverse() * p_M;
      const int other = (axis + 1) % 3, third = (axis + 2) % 3;
      if (std::abs(p_S[other]) > 0.5 * box->size[other]) continue;
      if (std::abs(p_S[third]) > 0.5 * box->size[third]) continue;
      heights.push_back(X_MS.translation.z() + 0.5 * box->size[axis]);
    }
    return heights;
  }
  const auto* mesh = std::get_if<Mesh>(&shape);
  if (mesh == nullptr) return heights;
  for (const auto& triangle : (*mesh)->triangles) {
    const Eigen::Vector3d a = X_MS * (*mesh)->vertices[triangle[0]],
                          b = X_MS * (*mesh)->vertices[triangle[1]],
                          c = X_MS * (*mesh)->vertices[triangle[2]];
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    if (normal.norm() <= 0.0 || std::abs(normal.z()) < std::cos(kLevel) * normal.norm()) continue;
    const bool faces_up = normal.z() > 0.0;  // sheets may be wound either way
    const auto& second = faces_up ? b : c;
    const auto& third = faces_up ? c : b;
    if (IsInside(p_M.head<2>(), a.head<2>(), second.head<2>(), third.head<2>()))
      heights.push_back((a.z() + b.z() + c.z()) / 3.0);
  }
  return heights;
}

/// The face under a point, if it goes on around it: a table's top is no floor.
std::optional<FloorFace> RoomUnder(const World& world, const Eigen::Vector3d& p_M) {
  constexpr double kAround = 0.75;  // [m]
  for (const double side : {kAround, -kAround}) {
    if (!FaceUnder(world, p_M + Eigen::Vector3d(side, 0.0, 0.0))) return std::nullopt;
    if (!FaceUnder(world, p_M + Eigen::Vector3d(0.0, side, 0.0))) return std::nullopt;
  }
  return FaceUnder(world, p_M);
}

void Lower(double by, World* world) {
  for (StaticBody& body : world->statics) body.X_MB.translation.z() -= by;
  for (auto& [name, X_MF] : world->frames) X_MF.translation.z() -= by;
  for (ObjectState& object : world->initial.objects) object.X_MO.translation.z() -= by;
  world->lowered_by += by;
}

}  // namespace

std::optional<FloorFace> FaceUnder(const World& world, const Eigen::Vector3d& p_M) {
  std::optional<FloorFace> highest;
  for (const StaticBody& body : world.statics) {
    for (const geometry::Collision& shape : body.collisions) {
      for (const double height : LevelFaces(shape.shape, body.X_MB * shape.X_BS, p_M)) {
        if (std::abs(height - p_M.z()) > kFloorStep) continue;
        if (!highest || height > highest->height) highest = FloorFace{height, shape.friction};
      }
    }
  }
  return highest;
}

World OnItsFloor(World world) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto& [name, X_MF] : world.frames) lowest = std::min(lowest, X_MF.translation.z());
  std::optional<FloorFace> face;
  for (const auto& [name, X_MF] : world.frames) {
    if (face || X_MF.translation.z() > lowest + kFloorStep) continue;
    face = RoomUnder(world, X_MF.translation);
  }
  if (!face) return world;
  if (std::abs(face->height) > kFloorStep) {
    Lower(face->height, &world);
    base::Log(
        base::LogLevel::kWarn,
        fmt::format("world={} floor={:.3f} m: areas stand on a face of that height; it counts "
                    "as z = 0, and so do all heights that are given",
                    world.name, face->height));
  }
  world.floor_friction = face->friction;
  world.hash = world.ComputeHash();
  return world;
}

Mesh WithoutFloor(const Mesh& mesh, const geometry::Pose3& X_WS, double top) {
  const auto height = [&](const Eigen::Vector3d& p_S) { return (X_WS * p_S).z(); };
  const bool reaches_so_low =
      std::any_of(mesh->vertices.begin(), mesh->vertices.end(),
                  [&](const Eigen::Vector3d& p_S) { return height(p_S) <= top; });
  if (!reaches_so_low) return mesh;
  auto left = std::make_shared<geometry::TriangleMesh>();
  for (const geometry::TriangleMesh& part : ConnectedParts(*mesh)) {
    const bool is_below = std::all_of(part.vertices.begin(), part.vertices.end(),
                                      [&](const Eigen::Vector3d& p) { return height(p) <= top; });
    if (is_below) continue;
    const bool is_solid = IsSolid(part);
    const int offset = static_cast<int>(left->vertices.size());
    left->vertices.insert(left->vertices.end(), part.vertices.begin(), part.vertices.end());
    for (const auto& t : part.triangles) {
      const bool is_low = height(part.vertices[t[0]]) <= top &&
                          height(part.vertices[t[1]]) <= top && height(part.vertices[t[2]]) <= top;
      if (is_low && !is_solid) continue;
      left->triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
    }
  }
  return left->triangles.empty() ? nullptr : Mesh(std::move(left));
}

}  // namespace hires::world
