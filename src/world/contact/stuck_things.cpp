#include "world/contact/stuck_things.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "hires/base/log.h"
#include "hires/base/text.h"
#include "hires/physics/physics_world.h"
#include "world/contact/overlap.h"

namespace hires::world {
namespace {

constexpr double kMostMovedOut = 0.02;  // [m] as much as hand-made worlds are inexact

/// Where a thing reaches deepest.
struct Stuck {
  std::string in;
  double depth{0.0};  // [m]
};

/// By the engine's contacts, as those would throw things apart, and by the outlines, as the depths
/// of meshes in meshes are at times too large.
class StuckFinder {
 public:
  explicit StuckFinder(const World& world) : world_(world), physics_(physics::PhysicsParams()) {
    physics_.AddFloor(world.floor_friction);
    for (const StaticBody& body : world.statics) physics_.AddStatic(body.collisions, body.X_MB);
    for (const ObjectState& object : world.initial.objects) {
      const auto model = world.ModelOf(object);
      const auto body = physics_.AddLoose(model->mass_properties, model->collisions,
                                          {object.X_MO, geometry::Twist3()});
      objects_[body] = &object;
    }
  }

  /// By name. Of two things in one another both.
  std::map<std::string, Stuck> Find() {
    for (const physics::Touch& touch : physics_.FindTouches()) {
      if (touch.depth <= kStartSlack) continue;
      const ObjectState& object = *objects_.at(touch.loose);
      const auto other = objects_.find(touch.other);
      if (other != objects_.end()) {
        const auto model = world_.ModelOf(*other->second);
        if (!Reaches(object, model->collisions, other->second->X_MO)) continue;
        Note(object.name, other->second->name, touch.depth);
        Note(other->second->name, object.name, touch.depth);
      } else if (touch.other == 0) {
        Note(object.name, "", touch.depth);
      } else {
        const StaticBody& body = world_.statics.at(touch.other - 1);
        if (Reaches(object, body.collisions, body.X_MB)) Note(object.name, body.name, touch.depth);
      }
    }
    return std::move(stuck_);
  }

 private:
  bool Reaches(const ObjectState& object, const std::vector<geometry::Collision>& shapes,
               const geometry::Pose3& X_MS) const {
    return Overlap(world_.ModelOf(object)->collisions, object.X_MO, shapes, X_MS);
  }

  void Note(const std::string& name, const std::string& in, double depth) {
    Stuck& stuck = stuck_[name];
    if (depth > stuck.depth) stuck = {in, depth};
  }

  const World& world_;
  physics::PhysicsWorld physics_;
  std::map<physics::BodyId, const ObjectState*> objects_;
  std::map<std::string, Stuck> stuck_;
};

/// What so many things have in common; the first in the order of the file's lines, as far as known.
void Say(const std::vector<const ObjectState*>& things, const std::map<std::string, Stuck>& stuck,
         const std::string& what, World* world) {
  if (things.empty()) return;
  const std::string& first = things.front()->name;
  const std::string source = SourceOf(first, *world);
  const Stuck& how = stuck.at(first);
  const std::string in = how.in.empty() ? "the floor" : fmt::format("'{}'", how.in);
  world->notes.push_back(fmt::format("{} {}: {}; {}{}'{}', {:.3f} m deep in {}", things.size(),
                                     things.size() == 1
                                         ? "loose thing stands in another one or in the floor"
                                         : "loose things stand in others or in the floor",
                                     what, things.size() == 1 ? "" : "first ",
                                     source.empty() ? "" : source + " ", first, how.depth, in));
  base::Log(base::LogLevel::kWarn,
            fmt::format("world={} note=\"{}\"", world->name, world->notes.back()));
}

bool ComesBeforeByName(const StaticBody& a, const StaticBody& b) {
  return base::ToLower(a.name) < base::ToLower(b.name);
}

}  // namespace

World HoldWhatIsStuck(World world) {
  if (world.initial.objects.empty()) return world;
  const std::map<std::string, Stuck> stuck = StuckFinder(world).Find();
  if (stuck.empty()) return world;
  std::vector<ObjectState> loose;
  std::vector<const ObjectState*> moved, held;
  const std::vector<ObjectState> all = std::move(world.initial.objects);
  for (const ObjectState& object : all) {
    const auto found = stuck.find(object.name);
    const bool is_held = found != stuck.end() && found->second.depth > kMostMovedOut;
    if (found != stuck.end()) (is_held ? held : moved).push_back(&object);
    if (is_held) {
      world.statics.push_back({object.name, object.X_MO, world.ModelOf(object)->collisions});
    } else {
      loose.push_back(object);
    }
  }
  world.initial.objects = std::move(loose);
  std::stable_sort(world.statics.begin(), world.statics.end(), ComesBeforeByName);
  Say(held, stuck,
      "physics would throw such apart, so they stay where the file has them, as obstacles; move "
      "them there if they shall be loose",
      &world);
  Say(moved, stuck, fmt::format("by at most {:g} m; such begin above or beside it", kMostMovedOut),
      &world);
  world.hash = world.ComputeHash();
  return world;
}

}  // namespace hires::world
