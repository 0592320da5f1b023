#include "lab/src/ladder/other_worlds.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hires/geometry/angles.h"

namespace hires::lab::ladder {
namespace {

using Eigen::Vector3d;
using geometry::Collision;
using geometry::TriangleMesh;

/// A grid of points over [0, 1] x [0, 1], two triangles for each cell.
/// @param at  where a point lies; with u to the right and v up, what is in front is outside.
template <typename Place>
void AddPatch(int columns, int rows, Place at, TriangleMesh* mesh) {
  const int first = static_cast<int>(mesh->vertices.size());
  for (int row = 0; row <= rows; ++row)
    for (int column = 0; column <= columns; ++column)
      mesh->vertices.push_back(at(double(column) / columns, double(row) / rows));
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const int corner = first + row * (columns + 1) + column, above = corner + columns + 1;
      mesh->triangles.push_back({corner, corner + 1, above + 1});
      mesh->triangles.push_back({corner, above + 1, above});
    }
  }
}

int Cells(double length, double edge) {
  return std::max(1, static_cast<int>(std::ceil(length / edge - 1e-9)));
}

TriangleMesh Cut(const geometry::Box& box, double edge) {
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    const int right = (axis + 1) % 3, up = (axis + 2) % 3;
    for (const double side : {-0.5, 0.5}) {
      const auto at = [&](double u, double v) {
        Vector3d p;
        p[axis] = side * box.size[axis];
        p[right] = (side > 0.0 ? u - 0.5 : 0.5 - u) * box.size[right];
        p[up] = (v - 0.5) * box.size[up];
        return p;
      };
      AddPatch(Cells(box.size[right], edge), Cells(box.size[up], edge), at, &mesh);
    }
  }
  return mesh;
}

int Segments(double radius, double edge) {
  return std::max(12, Cells(2.0 * geometry::kPi * radius, edge));
}

/// Turns a profile about z: `profile(v)` gives radius and height, its outside to the right of its
/// way.
template <typename Profile>
void AddTurned(int segments, int rows, Profile profile, TriangleMesh* mesh) {
  AddPatch(
      segments, rows,
      [&](double u, double v) {
        const Eigen::Vector2d at = profile(v);
        const double turn = 2.0 * geometry::kPi * u;
        return Vector3d(at.x() * std::cos(turn), at.x() * std::sin(turn), at.y());
      },
      mesh);
}

TriangleMesh Cut(const geometry::Cylinder& cylinder, double edge) {
  TriangleMesh mesh;
  const int segments = Segments(cylinder.radius, edge), rings = Cells(cylinder.radius, edge);
  const double r = cylinder.radius, h = 0.5 * cylinder.length;
  const auto bottom = [&](double v) { return Eigen::Vector2d(r * v, -h); };
  const auto side = [&](double v) { return Eigen::Vector2d(r, h * (2.0 * v - 1.0)); };
  const auto top = [&](double v) { return Eigen::Vector2d(r * (1.0 - v), h); };
  AddTurned(segments, rings, bottom, &mesh);
  AddTurned(segments, Cells(cylinder.length, edge), side, &mesh);
  AddTurned(segments, rings, top, &mesh);
  return mesh;
}

TriangleMesh Cut(const geometry::Sphere& sphere, double edge) {
  TriangleMesh mesh;
  const auto arc = [&](double v) {
    const double angle = geometry::kPi * (v - 0.5);
    return Eigen::Vector2d(sphere.radius * std::cos(angle), sphere.radius * std::sin(angle));
  };
  AddTurned(Segments(sphere.radius, edge), Cells(geometry::kPi * sphere.radius, edge), arc, &mesh);
  return mesh;
}

TriangleMesh Cut(const std::shared_ptr<const TriangleMesh>& mesh, double) { return *mesh; }

/// One corner for all patches that meet there, and no triangles without an area.
TriangleMesh Joined(const TriangleMesh& mesh) {
  constexpr double kGrid = 1e-7;  // [m]
  const auto key = [](const Vector3d& p) {
    return std::array<long, 3>{std::lround(p.x() / kGrid), std::lround(p.y() / kGrid),
                               std::lround(p.z() / kGrid)};
  };
  TriangleMesh joined;
  std::map<std::array<long, 3>, int> known;
  std::vector<int> now;
  for (const Vector3d& p : mesh.vertices) {
    const auto [found, is_new] = known.emplace(key(p), static_cast<int>(joined.vertices.size()));
    if (is_new) joined.vertices.push_back(p);
    now.push_back(found->second);
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    if (now[a] == now[b] || now[b] == now[c] || now[c] == now[a]) continue;
    joined.triangles.push_back({now[a], now[b], now[c]});
  }
  return joined;
}

void ToMeshes(double edge, std::vector<Collision>* collisions) {
  for (Collision& collision : *collisions) {
    collision.shape = std::make_shared<const TriangleMesh>(Triangulated(collision.shape, edge));
  }
}

double VolumeOf(const geometry::Aabb& bounds) { return (bounds.upper - bounds.lower).prod(); }

/// Of solid parts of one density, each taken as the box around it.
geometry::MassProperties SolidMass(const std::vector<Collision>& collisions, double mass) {
  double volume = 0.0;
  Vector3d moment = Vector3d::Zero();
  std::vector<geometry::Aabb> parts;
  for (const Collision& collision : collisions) {
    const geometry::Aabb& part =
        parts.emplace_back(geometry::BoundsOf(collision.shape, collision.X_BS));
    volume += VolumeOf(part);
    moment += VolumeOf(part) * 0.5 * (part.lower + part.upper);
  }
  geometry::MassProperties solid{mass, moment / volume, Eigen::Matrix3d::Zero()};
  for (const geometry::Aabb& part : parts) {
    const double share = mass * VolumeOf(part) / volume;
    const Vector3d d = 0.5 * (part.lower + part.upper) - solid.p_BBcm;
    solid.I_BBcm += geometry::SolidInertia(geometry::Box{part.upper - part.lower}, share) +
                    share * (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose());
  }
  return solid;
}

world::World Hashed(world::World world) {
  world.hash = world.ComputeHash();
  return world;
}

}  // namespace

TriangleMesh Triangulated(const geometry::Shape& shape, double edge) {
  return Joined(std::visit([&](const auto& of) { return Cut(of, edge); }, shape));
}

world::World WithLoose(world::World world, const std::string& prefix, double mass) {
  std::vector<world::StaticBody> fixed;
  for (world::StaticBody& body : world.statics) {
    if (body.name.rfind(prefix, 0) != 0) {
      fixed.push_back(std::move(body));
      continue;
    }
    const std::string model = "loose_" + body.name;
    world.models[model] = std::make_shared<const world::ObjectModel>(
        world::ObjectModel{model, SolidMass(body.collisions, mass), body.collisions});
    world.initial.objects.push_back({body.name, model, body.X_MB, {}, ""});
  }
  world.statics = std::move(fixed);
  return Hashed(std::move(world));
}

world::World WithMeshStatics(world::World world, double edge) {
  for (world::StaticBody& body : world.statics) ToMeshes(edge, &body.collisions);
  return Hashed(std::move(world));
}

world::World WithMeshObjects(world::World world, double edge) {
  for (auto& [name, model] : world.models) {
    auto meshes = std::make_shared<world::ObjectModel>(*model);
    ToMeshes(edge, &meshes->collisions);
    model = std::move(meshes);
  }
  return Hashed(std::move(world));
}

world::World WithHighStaticsOnly(world::World world, double height) {
  const auto is_low = [&](const world::StaticBody& body) {
    geometry::Aabb bounds;
    for (const Collision& part : body.collisions)
      bounds.Include(geometry::BoundsOf(part.shape, body.X_MB * part.X_BS));
    return bounds.upper.z() <= height;
  };
  world.statics.erase(std::remove_if(world.statics.begin(), world.statics.end(), is_low),
                      world.statics.end());
  return Hashed(std::move(world));
}

std::shared_ptr<const simulation::Scene> SceneIn(world::World world,
                                                 const simulation::Scene& like) {
  return simulation::MakeScene(std::move(world), like.robot, like.memory, like.sight);
}

int NumTriangles(const std::vector<Collision>& collisions) {
  std::size_t count = 0;
  for (const Collision& collision : collisions) {
    const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh>>(&collision.shape);
    if (mesh != nullptr) count += (*mesh)->triangles.size();
  }
  return static_cast<int>(count);
}

}  // namespace hires::lab::ladder
