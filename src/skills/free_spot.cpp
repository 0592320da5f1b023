#include "skills/free_spot.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/geometry/angles.h"

namespace hires::skills {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::Polygon;
using geometry::Pose3;

constexpr int kCorners = 24;             // of a circle
constexpr double kSlotClearance = 0.01;  // [m] between things on the tray, whose places are close

struct Neighbour {
  std::string name;
  Polygon outline_A;
};

std::vector<Neighbour> NeighboursIn(const world::World& world, const Pose3& X_MA,
                                    const std::vector<world::ObjectState>& others) {
  std::vector<Neighbour> neighbours;
  for (const world::ObjectState& other : others) {
    const auto model = world.FindModel(other.model);
    if (!model) continue;
    const Pose3 X_AO = X_MA.Inverse() * other.X_MO;
    if (std::abs(X_AO.translation.z()) > kSameLevel) continue;
    neighbours.push_back({other.name, OutlineOf(*model, X_AO)});
  }
  return neighbours;
}

Polygon Circle(const Vector2d& centre, double radius) {
  Polygon circle;
  const double outside = radius / std::cos(geometry::kPi / kCorners);
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2.0 * geometry::kPi * i / kCorners;
    circle.push_back(centre + outside * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return circle;
}

/// In shares of the way from the middle to the edge.
const std::map<std::string, Vector2d>& Spots() {
  static const std::map<std::string, Vector2d> spots{
      {"middle", {0.0, 0.0}},       {"front", {1.0, 0.0}},      {"back", {-1.0, 0.0}},
      {"left", {0.0, 1.0}},         {"right", {0.0, -1.0}},     {"front_left", {1.0, 1.0}},
      {"front_right", {1.0, -1.0}}, {"back_left", {-1.0, 1.0}}, {"back_right", {-1.0, -1.0}}};
  return spots;
}

/// Keeps the candidates that are free; notes who takes up the others.
FreeSpots KeepFree(const std::vector<Vector2d>& candidates_A, double radius, double clearance,
                   const std::vector<Neighbour>& neighbours) {
  FreeSpots free;
  std::set<std::string> occupants;
  for (const Vector2d& p_A : candidates_A) {
    const Polygon circle = Circle(p_A, radius);
    bool is_free = true;
    for (const Neighbour& neighbour : neighbours) {
      if (geometry::Distance(circle, neighbour.outline_A) >= clearance) continue;
      occupants.insert(neighbour.name);
      is_free = false;
    }
    if (is_free) free.spots_A.emplace_back(p_A.x(), p_A.y(), 0.0);
  }
  free.occupants.assign(occupants.begin(), occupants.end());
  return free;
}

/// A grid over a room, nearest to the origin first; equally near ones in a fixed order.
std::vector<Vector2d> Grid(const Eigen::AlignedBox2d& room, double spacing) {
  const auto steps = [spacing](double length) {
    return static_cast<int>(std::floor(length / spacing + 1e-9));
  };
  std::vector<Vector2d> grid;
  for (int i = -steps(-room.min().x()); i <= steps(room.max().x()); ++i) {
    for (int j = -steps(-room.min().y()); j <= steps(room.max().y()); ++j) {
      grid.emplace_back(i * spacing, j * spacing);
    }
  }
  std::stable_sort(grid.begin(), grid.end(), [](const Vector2d& a, const Vector2d& b) {
    return a.squaredNorm() < b.squaredNorm() - 1e-12;
  });
  return grid;
}

}  // namespace

Polygon OutlineOf(const world::ObjectModel& model, const Pose3& X_AO) {
  std::vector<Vector2d> corners;
  for (const geometry::Collision& shape : model.collisions) {
    const Pose3 X_AS = X_AO * shape.X_BS;
    const geometry::Aabb bounds = geometry::BoundsOf(shape.shape, X_AS);
    const auto outline =
        geometry::OutlineInBand(shape.shape, X_AS, bounds.lower.z(), bounds.upper.z());
    if (outline) corners.insert(corners.end(), outline->begin(), outline->end());
  }
  return geometry::ConvexHull(std::move(corners));
}

double RadiusOf(const world::ObjectModel& model) {
  return geometry::CircumscribedRadius(OutlineOf(model, Pose3{})) *
         std::cos(geometry::kPi / kCorners);
}

PlacingArea AreaIn(const world::World& world, const std::string& area, const PlaceParams& params) {
  const auto X_MA = world.FindFrame(area);
  if (!X_MA) throw base::ConfigError(base::UnknownName("area", area, world.FrameNames()));
  return {*X_MA, world::Inset(world.ExtentOf(area), params.area_edge)};
}

FreeSpots FindFreeSpots(const PlaceParams& params, const world::World& world,
                        const world::ObjectModel& object, const PlacingArea& area,
                        const std::vector<world::ObjectState>& others) {
  const double radius = RadiusOf(object);
  return KeepFree(Grid(world::Inset(area.extent_A, radius), params.spot_spacing), radius,
                  params.clearance, NeighboursIn(world, area.X_MA, others));
}

std::vector<std::string> SpotNames() {
  std::vector<std::string> names;
  for (const auto& entry : Spots()) names.push_back(entry.first);
  return names;
}

std::optional<Vector2d> ParseSpot(const std::string& name) {
  const std::string lower = base::ToLower(name);
  if (lower == kAnySpot) return std::nullopt;
  const auto found = Spots().find(lower);
  if (found != Spots().end()) return found->second;
  std::vector<std::string> known = SpotNames();
  known.insert(known.begin(), kAnySpot);
  throw base::ConfigError(base::UnknownName("spot", name, known));
}

FreeSpots FindStatedSpot(const PlaceParams& params, const world::World& world,
                         const world::ObjectModel& object, const PlacingArea& area,
                         const std::vector<world::ObjectState>& others, const Vector2d& spot) {
  const double radius = RadiusOf(object);
  const Eigen::AlignedBox2d room = world::Inset(area.extent_A, radius);
  const auto along = [&](int axis) {
    return spot[axis] * (spot[axis] < 0.0 ? -room.min()[axis] : room.max()[axis]);
  };
  return KeepFree({{along(0), along(1)}}, radius, params.clearance,
                  NeighboursIn(world, area.X_MA, others));
}

FreeSpots FindFreeSlots(const PlaceParams& params, const world::World& world,
                        const world::ObjectModel& object, const Pose3& X_MSlot,
                        const std::vector<world::ObjectState>& others) {
  return KeepFree({{0.0, 0.0}, {0.0, -params.slot_distance}, {0.0, params.slot_distance}},
                  RadiusOf(object), kSlotClearance, NeighboursIn(world, X_MSlot, others));
}

}  // namespace hires::skills
