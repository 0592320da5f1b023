#include "world/floor_level.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "geometry/mesh_pieces.h"
#include "hires/base/log.h"
#include "hires/geometry/angles.h"
#include "hires/world/floor.h"
#include "hires/world/occupancy_grid.h"
#include "world/map_region.h"

namespace hires::world {
namespace {

using Mesh = std::shared_ptr<const geometry::TriangleMesh>;

constexpr double kLevel = 1e-3;       // [rad] that a level face may be tilted
constexpr double kSameHeight = 1e-6;  // [m]

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
  if (const auto* cylinder = std::get_if<geometry::Cylinder>(&shape)) {
    const bool is_upright =
        std::abs((X_MS.rotation * Eigen::Vector3d::UnitZ()).z()) >= std::cos(kLevel);
    const double off = (p_M - X_MS.translation).head<2>().norm();
    if (is_upright && off <= cylinder->radius)
      heights.push_back(X_MS.translation.z() + 0.5 * cylinder->length);
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

/// Under a point or just beside it: joints between tiles are no end of a floor.
std::optional<FloorFace> FaceNear(const World& world, const Eigen::Vector3d& p_M) {
  constexpr double kJoint = 0.02;  // [m] to either side
  if (auto face = FaceUnder(world, p_M)) return face;
  for (const double x : {kJoint, -kJoint}) {
    for (const double y : {kJoint, -kJoint}) {
      if (auto face = FaceUnder(world, p_M + Eigen::Vector3d(x, y, 0.0))) return face;
    }
  }
  return std::nullopt;
}

bool GoesOnAllAround(const World& world, const Eigen::Vector3d& p_M) {
  constexpr double kAround = 0.75;  // [m]
  for (const double side : {kAround, -kAround}) {
    if (!FaceNear(world, p_M + Eigen::Vector3d(side, 0.0, 0.0))) return false;
    if (!FaceNear(world, p_M + Eigen::Vector3d(0.0, side, 0.0))) return false;
  }
  return true;
}

/// As in a corridor: no table is as long.
bool GoesOnOneWay(const World& world, const Eigen::Vector3d& p_M) {
  constexpr int kDirections = 48;              // so close that a corridor of 0.4 m has one
  constexpr double kFar = 3.0, kProbe = 0.25;  // [m]
  for (int i = 0; i < kDirections; ++i) {
    const double yaw = 2.0 * geometry::kPi * i / kDirections;
    const Eigen::Vector3d along(std::cos(yaw), std::sin(yaw), 0.0);
    double way = kProbe;
    while (way <= kFar && FaceNear(world, p_M + way * along)) way += kProbe;
    if (way > kFar) return true;
  }
  return false;
}

/// The face under a point, if it goes on from it: a table's top is no floor.
std::optional<FloorFace> RoomUnder(const World& world, const Eigen::Vector3d& p_M) {
  auto face = FaceNear(world, p_M);
  if (face && !GoesOnAllAround(world, p_M) && !GoesOnOneWay(world, p_M)) face.reset();
  return face;
}

/// Of the lowest areas that stand on something. What lies in the ground, and nothing bears it, is
/// no place to stand at; the floor z = 0 bears what lies on it or higher.
std::optional<FloorFace> FloorOf(const World& world) {
  double above = -std::numeric_limits<double>::infinity();
  while (above < -kFloorStep) {
    double lowest = std::numeric_limits<double>::infinity();
    for (const auto& [name, X_MF] : world.frames) {
      const double z = X_MF.translation.z();
      if (z > above) lowest = std::min(lowest, z);
    }
    for (const auto& [name, X_MF] : world.frames) {
      const double z = X_MF.translation.z();
      if (z <= above || z > lowest + kFloorStep) continue;
      if (auto face = RoomUnder(world, X_MF.translation)) return face;
    }
    above = lowest;
  }
  return std::nullopt;
}

/// World::ground_depth of a floor that consists of such faces.
double GroundBelow(const FloorFace& face, bool has_plane) {
  const bool lies_on_ground = face.bottom >= -kSameHeight && face.height > kSameHeight;
  if (has_plane || lies_on_ground) return face.height > kFloorStep ? face.height : 0.0;
  return std::numeric_limits<double>::infinity();
}

std::string WithSource(const std::string& name, const World& world) {
  const std::string source = SourceOf(name, world);
  return fmt::format("'{}'{}", name, source.empty() ? "" : " (" + source + ")");
}

/// @param what  lies at z = 0 now: what people should know who know the file's heights.
void TellLowered(const std::string& what, const World& world) {
  if (std::abs(world.lowered_by) <= kSameHeight) return;
  base::Log(base::LogLevel::kWarn,
            fmt::format("world={} floor={:.3f} m: {} counts as z = 0, and so do all heights that "
                        "are given",
                        world.name, world.lowered_by, what));
}

void Lower(double by, World* world) {
  for (StaticBody& body : world->statics) body.X_MB.translation.z() -= by;
  for (auto& [name, X_MF] : world->frames) X_MF.translation.z() -= by;
  for (ObjectState& object : world->initial.objects) object.X_MO.translation.z() -= by;
  world->lowered_by += by;
}

/// Where something could stand: on the floor z = 0, and on level faces above it that go on as
/// floors do. What lies in something has no room to stand, as a floor below a slab.
class Levels {
 public:
  explicit Levels(const World& world) : world_(world) {
    for (const StaticBody& body : world.statics) {
      for (const geometry::Collision& shape : body.collisions)
        shapes_.push_back({&body, &shape, geometry::BoundsOf(shape.shape, body.X_MB * shape.X_BS)});
    }
  }

  struct Level {
    double height;
    double bottom;  ///< of the shape that it is the top of
  };

  /// From below; none where there is no room on any of them.
  std::vector<Level> At(const Eigen::Vector2d& p_M) {
    const std::vector<const Placed*> here = ShapesAt(p_M);
    std::vector<Level> levels;
    if (HasRoom(here, p_M, 0.0)) levels.push_back({0.0, 0.0});
    for (const Placed* placed : here) {
      const geometry::Pose3 X_MS = placed->body->X_MB * placed->shape->X_BS;
      for (const double height : LevelFaces(placed->shape->shape, X_MS, {p_M.x(), p_M.y(), 0.0})) {
        if (height <= kFloorStep || !HasRoom(here, p_M, height)) continue;
        if (IsFloor(*placed, {p_M.x(), p_M.y(), height}))
          levels.push_back({height, placed->bounds.lower.z()});
      }
    }
    std::sort(levels.begin(), levels.end(),
              [](const Level& a, const Level& b) { return a.height < b.height; });
    return levels;
  }

  /// Whether the floor z = 0 is one of them; quicker.
  bool HasGround(const Eigen::Vector2d& p_M) const { return HasRoom(ShapesAt(p_M), p_M, 0.0); }

  static constexpr double kRoom = 0.3;  ///< [m] above a level; below a lower ceiling few robots fit

 private:
  struct Placed {
    const StaticBody* body;
    const geometry::Collision* shape;
    geometry::Aabb bounds;
  };

  std::vector<const Placed*> ShapesAt(const Eigen::Vector2d& p_M) const {
    std::vector<const Placed*> here;
    for (const Placed& placed : shapes_) {
      const Eigen::Vector2d lower = placed.bounds.lower.head<2>(),
                            upper = placed.bounds.upper.head<2>();
      const bool is_here =
          (p_M.array() >= lower.array()).all() && (p_M.array() <= upper.array()).all();
      if (is_here) here.push_back(&placed);
    }
    return here;
  }

  static bool HasRoom(const std::vector<const Placed*>& here, const Eigen::Vector2d& p_M,
                      double height) {
    const double from = height + kFloorStep, to = height + kRoom;
    for (const Placed* placed : here) {
      if (placed->bounds.lower.z() > to || placed->bounds.upper.z() < from) continue;
      World alone;
      alone.statics = {{"", placed->body->X_MB, {*placed->shape}}};
      for (const geometry::Polygon& outline : OutlinesInBand(alone, nullptr, from, to))
        if (geometry::Contains(outline, p_M)) return false;
    }
    return true;
  }

  /// Many areas lie on one floor, and to look around takes long.
  bool IsFloor(const Placed& placed, const Eigen::Vector3d& p_M) {
    const std::pair<const geometry::Collision*, double> key(placed.shape, p_M.z());
    if (floors_.count(key) > 0) return true;
    const bool is_floor = RoomUnder(world_, p_M).has_value();
    if (is_floor) floors_.insert(key);
    return is_floor;
  }

  const World& world_;
  std::vector<Placed> shapes_;
  std::set<std::pair<const geometry::Collision*, double>> floors_;
};

/// [m] The slab that lies on the floor z = 0 under a point where that has no room, or 0: a storey
/// above a cupboard is none.
double SlabAt(const Eigen::Vector2d& p_M, Levels* levels) {
  constexpr double kThickest = 1.5;  // [m]
  if (levels->HasGround(p_M)) return 0.0;
  for (const Levels::Level& level : levels->At(p_M))
    if (level.bottom <= Levels::kRoom && level.height <= kThickest) return level.height;
  return 0.0;
}

/// [m] The level that lies nearest to a height; 0 where there is none.
double NearestLevel(double wanted, const Eigen::Vector2d& p_M, Levels* levels) {
  const std::vector<Levels::Level> possible = levels->At(p_M);
  const auto nearest =
      std::min_element(possible.begin(), possible.end(), [&](const auto& a, const auto& b) {
        return std::abs(a.height - wanted) < std::abs(b.height - wanted);
      });
  return nearest == possible.end() ? 0.0 : nearest->height;
}

/// [m] of each area: of the level nearest to the height that it has, else of the floor on which the
/// world's own areas make robots stand, else of the slab under it.
std::vector<double> HeightsOf(const std::vector<NamedArea>& areas, const World& world) {
  const std::optional<FloorFace> own = FloorOf(world);
  Levels levels(world);
  std::vector<double> heights;
  for (const NamedArea& area : areas) {
    const Eigen::Vector2d p_M = area.X_MA.position();
    if (area.z) {
      heights.push_back(NearestLevel(*area.z - world.lowered_by, p_M, &levels));
    } else {
      heights.push_back(own ? own->height : SlabAt(p_M, &levels));
    }
  }
  return heights;
}

}  // namespace

std::optional<FloorFace> FaceUnder(const World& world, const Eigen::Vector3d& p_M) {
  std::optional<FloorFace> highest;
  const StaticBody* body_under = nullptr;
  const geometry::Collision* shape_under = nullptr;
  for (const StaticBody& body : world.statics) {
    for (const geometry::Collision& shape : body.collisions) {
      for (const double height : LevelFaces(shape.shape, body.X_MB * shape.X_BS, p_M)) {
        if (std::abs(height - p_M.z()) > kFloorStep) continue;
        if (highest && height <= highest->height) continue;
        highest = FloorFace{height, shape.friction, "", 0.0};
        body_under = &body;
        shape_under = &shape;
      }
    }
  }
  if (!highest) return highest;
  highest->name = NameOf(*body_under, *shape_under);
  highest->bottom =
      geometry::BoundsOf(shape_under->shape, body_under->X_MB * shape_under->X_BS).lower.z();
  return highest;
}

World OnItsFloor(World world, bool has_plane) {
  const std::optional<FloorFace> face = FloorOf(world);
  if (!face) return world;
  world.ground_depth = GroundBelow(*face, has_plane);
  if (std::abs(face->height) > kFloorStep) {
    Lower(face->height, &world);
    TellLowered("areas stand on a face of that height; it", world);
  }
  if (world.ground_depth > 0.0) {
    world.notes.push_back(
        fmt::format("the floor ends where {} and what else bears a robot end: drives are planned "
                    "to keep on it, but what slides, falls or drives blindly beyond is imagined as "
                    "on a floor without end",
                    WithSource(face->name, world)));
  }
  world.floor_friction = face->friction;
  world.hash = world.ComputeHash();
  return world;
}

World OnItsFloor(World world, const std::optional<FloorPlane>& plane,
                 const std::vector<NamedArea>& areas) {
  if (plane && std::abs(plane->height) > kSameHeight) Lower(plane->height, &world);
  if (plane) world.floor_friction = plane->friction;
  AddAreas(areas, HeightsOf(areas, world), &world);
  world.hash = world.ComputeHash();
  const double lowered_by = world.lowered_by;
  world = OnItsFloor(std::move(world), plane.has_value());
  if (world.lowered_by == lowered_by && plane)
    TellLowered(plane->where + " is the floor; its height", world);
  NoteMapRegion(&world);
  return world;
}

std::string WhyElsewhere(const World& world, const std::string& area, double step) {
  const auto X_MF = world.FindFrame(area);
  if (!X_MF || std::abs(X_MF->translation.z()) <= step) return "";
  const auto face = RoomUnder(world, X_MF->translation);
  if (!face) return "";
  const double z = face->height;
  return fmt::format(
      "area '{}' stands on {}, {:.2f} m {} than the floor on which the robot drives (z {:.2f} m "
      "and "
      "{:.2f} m of the world's file), and drives are imagined on one level, that of the lowest "
      "area that something bears; name areas of that level, or take those of others out of the "
      "world",
      area, WithSource(face->name, world), std::abs(z), z > 0.0 ? "higher" : "lower",
      z + world.lowered_by, world.lowered_by);
}

std::string WhyInFloor(const World& world, const std::string& shape, const Eigen::Vector2d& p_M) {
  const Eigen::Vector3d here_M(p_M.x(), p_M.y(), 0.0);
  const auto lowest =
      std::min_element(world.frames.begin(), world.frames.end(), [](const auto& a, const auto& b) {
        return a.second.translation.z() < b.second.translation.z();
      });
  for (const StaticBody& body : world.statics) {
    for (const geometry::Collision& part : body.collisions) {
      if (NameOf(body, part) != shape || lowest == world.frames.end()) continue;
      for (const double height : LevelFaces(part.shape, body.X_MB * part.X_BS, here_M)) {
        const Eigen::Vector3d top_M(p_M.x(), p_M.y(), height);
        if (height <= kFloorStep || !RoomUnder(world, top_M)) continue;
        return fmt::format(
            "the top of '{}', z {:.3f} m of the world's file, is a floor, and robots stand at z "
            "{:.3f} m (the lowest area, '{}', has z {:.3f} m); give areas on a floor its height: "
            "drives are imagined on one level",
            shape, height + world.lowered_by, world.lowered_by, lowest->first,
            lowest->second.translation.z() + world.lowered_by);
      }
    }
  }
  return "";
}

Mesh WithoutFloor(const Mesh& mesh, const geometry::Pose3& X_WS, double top) {
  const auto height = [&](const Eigen::Vector3d& p_S) { return (X_WS * p_S).z(); };
  const bool reaches_so_low =
      std::any_of(mesh->vertices.begin(), mesh->vertices.end(),
                  [&](const Eigen::Vector3d& p_S) { return height(p_S) <= top; });
  if (!reaches_so_low) return mesh;
  auto left = std::make_shared<geometry::TriangleMesh>();
  for (const geometry::TriangleMesh& part : geometry::ConnectedParts(*mesh)) {
    const bool is_below = std::all_of(part.vertices.begin(), part.vertices.end(),
                                      [&](const Eigen::Vector3d& p) { return height(p) <= top; });
    if (is_below) continue;
    const bool is_solid = geometry::IsSolid(part);
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
