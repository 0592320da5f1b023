#include "imagination/object_support.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "hires/geometry/polygon.h"

namespace hires::imagination {
namespace {

/// What may bear a thing: its name, and the box round one of its shapes.
using Bearer = std::pair<std::string, geometry::Aabb>;

geometry::Aabb BoundsOfObject(const world::ObjectState& object, const world::World& world) {
  geometry::Aabb bounds;
  for (const geometry::Collision& shape : world.ModelOf(object)->collisions)
    bounds.Include(geometry::BoundsOf(shape.shape, object.X_MO * shape.X_BS));
  return bounds;
}

std::vector<Bearer> BearersIn(const world::WorldState& state, const world::World& world) {
  std::vector<Bearer> bearers;
  for (const world::StaticBody& body : world.statics) {
    for (const geometry::Collision& shape : body.collisions) {
      bearers.emplace_back(world::NameOf(body, shape),
                           geometry::BoundsOf(shape.shape, body.X_MB * shape.X_BS));
    }
  }
  for (const world::ObjectState& object : state.objects)
    bearers.emplace_back(object.name, BoundsOfObject(object, world));
  return bearers;
}

/// The highest one that ends below the thing and lies under it; the floor where there is none.
/// Nothing: something reaches up to it.
std::optional<Bearer> HighestBelow(const geometry::Aabb& thing, const std::string& name,
                                   const std::vector<Bearer>& bearers) {
  constexpr double kDrop = 0.06;  // [m] that a thing is let go from and stays where it lands
  Bearer highest{"the floor", {}};
  highest.second.upper.z() = 0.0;
  if (thing.lower.z() <= kDrop) return std::nullopt;
  for (const Bearer& one : bearers) {
    const geometry::Aabb& box = one.second;
    const bool is_under = (box.lower.head<2>().array() <= thing.upper.head<2>().array()).all() &&
                          (box.upper.head<2>().array() >= thing.lower.head<2>().array()).all() &&
                          box.lower.z() <= thing.lower.z();
    if (!is_under || one.first == name) continue;
    if (box.upper.z() >= thing.lower.z() - kDrop) return std::nullopt;
    if (box.upper.z() > highest.second.upper.z()) highest = one;
  }
  return highest;
}

}  // namespace

std::vector<std::string> WhyUnsupported(const std::vector<std::string>& objects,
                                        const world::WorldState& state, const world::World& world,
                                        const geometry::Pose2& X_MB, double reach) {
  const std::vector<Bearer> bearers = BearersIn(state, world);
  std::vector<std::string> texts;
  for (const std::string& name : objects) {
    const world::ObjectState* object = state.Find(name);
    if (object == nullptr || !object->attached_to.empty()) continue;
    const geometry::Aabb thing = BoundsOfObject(*object, world);
    const Eigen::Vector3d& p_M = object->X_MO.translation;
    if (thing.upper.z() < -world.ground_depth) {
      texts.push_back(fmt::format(
          "'{}' would lie below the floor, at z {:.3g} m; give the height of what it stands on",
          object->name, p_M.z()));
      continue;
    }
    const bool is_on_robot = (p_M.head<2>() - X_MB.position()).norm() <= reach;
    const auto below = HighestBelow(thing, object->name, bearers);
    if (is_on_robot || !below) continue;
    const double top = below->second.upper.z();
    texts.push_back(fmt::format(
        "'{}' would hang at z {:.3g} m, {:.3g} m over {}, and fall; give the height of what it "
        "stands on: {:.3g}",
        object->name, p_M.z(), thing.lower.z() - top,
        top > 0.0 ? "'" + below->first + "'" : below->first, top));
  }
  return texts;
}

std::vector<std::string> WhyUnsupported(const std::vector<std::string>& objects,
                                        const RolloutSetup& setup) {
  constexpr double kBesideRobot = 0.1;  // [m]
  const simulation::Scene& scene = *setup.scene;
  return WhyUnsupported(
      objects, setup.world_state, scene.world, setup.robot_state.X_MB,
      kBesideRobot + geometry::CircumscribedRadius(scene.robot.profile.footprint));
}

}  // namespace hires::imagination
