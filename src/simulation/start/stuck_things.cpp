#include "hires/simulation/stuck_things.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "hires/base/log.h"
#include "hires/base/text.h"
#include "hires/physics/physics_world.h"
#include "simulation/start/overlap.h"

namespace hires::simulation {
namespace {

constexpr double kMostMovedOut = 0.02;  // [m] as much as hand-made worlds are inexact

/// Where a thing reaches deepest.
struct Stuck {
  std::string in;           // another or what never moves; "": the floor alone
  double depth{0.0};        // [m] in that
  double below_floor{0.0};  // [m]
};

/// By the engine's contacts, as those would throw things apart, and by the outlines, as the depths
/// of meshes in meshes are at times too large.
class StuckFinder {
 public:
  explicit StuckFinder(const world::World& world)
      : world_(world), physics_(physics::PhysicsParams()) {
    physics_.AddFloor(world.floor_friction);
    for (const world::StaticBody& body : world.statics)
      physics_.AddStatic(body.collisions, body.X_MB);
    for (const world::ObjectState& object : world.initial.objects) {
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
      const world::ObjectState& object = *objects_.at(touch.loose);
      const auto other = objects_.find(touch.other);
      if (other != objects_.end()) {
        const auto model = world_.ModelOf(*other->second);
        if (!Reaches(object, model->collisions, other->second->X_MO)) continue;
        Note(object.name, other->second->name, touch.depth);
        Note(other->second->name, object.name, touch.depth);
      } else if (touch.other == 0) {
        stuck_[object.name].below_floor = touch.depth;
      } else {
        const world::StaticBody& body = world_.statics.at(touch.other - 1);
        if (Reaches(object, body.collisions, body.X_MB)) Note(object.name, body.name, touch.depth);
      }
    }
    return std::move(stuck_);
  }

 private:
  bool Reaches(const world::ObjectState& object, const std::vector<geometry::Collision>& shapes,
               const geometry::Pose3& X_MS) const {
    return Overlap(world_.ModelOf(object)->collisions, object.X_MO, shapes, X_MS);
  }

  void Note(const std::string& name, const std::string& in, double depth) {
    Stuck& stuck = stuck_[name];
    if (depth <= stuck.depth) return;
    stuck.in = in;
    stuck.depth = depth;
  }

  const world::World& world_;
  physics::PhysicsWorld physics_;
  std::map<physics::BodyId, const world::ObjectState*> objects_;
  std::map<std::string, Stuck> stuck_;
};

/// What so many things have in common.
void Say(const std::vector<const world::ObjectState*>& things,
         const std::map<std::string, Stuck>& stuck, const std::string& what, world::World* world) {
  if (things.empty()) return;
  const std::string& first = things.front()->name;
  const std::string source = world::SourceOf(first, *world);
  const Stuck& how = stuck.at(first);
  const bool is_one = things.size() == 1;
  world->notes.push_back(fmt::format("{} loose thing{} {}; {}{}{}'{}', {:.3f} m deep in {}",
                                     things.size(), is_one ? "" : "s", what, is_one ? "" : "first ",
                                     source, source.empty() ? "" : " ", first,
                                     how.in.empty() ? how.below_floor : how.depth,
                                     how.in.empty() ? "the floor" : fmt::format("'{}'", how.in)));
  base::Log(base::LogLevel::kWarn,
            fmt::format("world={} note=\"{}\"", world->name, world->notes.back()));
}

bool ComesBeforeByName(const world::StaticBody& a, const world::StaticBody& b) {
  return base::ToLower(a.name) < base::ToLower(b.name);
}

}  // namespace

world::World HoldWhatIsStuck(world::World world) {
  if (world.initial.objects.empty()) return world;
  const std::map<std::string, Stuck> stuck = StuckFinder(world).Find();
  if (stuck.empty()) return world;
  std::vector<world::ObjectState> loose;
  std::vector<const world::ObjectState*> held, lifted, moved;
  const std::vector<world::ObjectState> all = std::move(world.initial.objects);
  for (const world::ObjectState& object : all) {
    const auto found = stuck.find(object.name);
    if (found != stuck.end() && found->second.depth > kMostMovedOut) {
      held.push_back(&object);
      world.statics.push_back({object.name, object.X_MO, world.ModelOf(object)->collisions});
      continue;
    }
    if (found != stuck.end()) (found->second.in.empty() ? lifted : moved).push_back(&object);
    loose.push_back(object);
  }
  world.initial.objects = std::move(loose);
  std::stable_sort(world.statics.begin(), world.statics.end(), ComesBeforeByName);
  Say(held, stuck,
      "in one another or in what never moves: physics would throw such apart, so they stay where "
      "the file has them, as obstacles; move them there if they shall be loose",
      &world);
  Say(lifted, stuck, "in the floor: such begin on it", &world);
  Say(moved, stuck,
      fmt::format("at most {:g} m deep in one another or in what never moves: such begin beside it",
                  kMostMovedOut),
      &world);
  world.hash = world.ComputeHash();
  return world;
}

}  // namespace hires::simulation
