#include "lab/src/series/overlaps.h"

#include <algorithm>

#include "hires/simulation/robot_clearance.h"

namespace hires::lab {
namespace {

using geometry::Collision;
using world::StaticBody;
using world::World;

constexpr double kUnmoved = 1e-6;  // [m] and [rad]

const StaticBody* Find(const World& world, const std::string& name) {
  const auto found = std::find_if(world.statics.begin(), world.statics.end(),
                                  [&](const StaticBody& body) { return body.name == name; });
  return found == world.statics.end() ? nullptr : &*found;
}

bool IsMoved(const StaticBody& body, const World& original) {
  const StaticBody* before = Find(original, body.name);
  if (before == nullptr) return true;
  return (body.X_MB.translation - before->X_MB.translation).norm() > kUnmoved ||
         body.X_MB.rotation.angularDistance(before->X_MB.rotation) > kUnmoved;
}

bool Touch(const std::vector<Collision>& shapes_B, const geometry::Pose2& X_MB,
           const StaticBody& other) {
  World alone;
  alone.statics = {other};
  return simulation::RobotClearance(shapes_B, alone).FindContact(X_MB).has_value();
}

bool Touch(const StaticBody& body, const StaticBody& other) {
  std::vector<Collision> shapes_M = body.collisions;
  for (Collision& shape : shapes_M) shape.X_BS = body.X_MB * shape.X_BS;
  return Touch(shapes_M, {}, other);
}

/// Whether both are in the original and touch there.
bool Touched(const World& original, const std::string& one, const std::string& other) {
  const StaticBody* first = Find(original, one);
  const StaticBody* second = Find(original, other);
  return first != nullptr && second != nullptr && Touch(*first, *second);
}

}  // namespace

std::vector<Overlap> NewOverlaps(const WorldAtStart& original, const WorldAtStart& varied,
                                 const std::string& robot,
                                 const std::vector<Collision>& robot_shapes_B) {
  std::vector<Overlap> overlaps;
  const std::vector<StaticBody>& bodies = varied.world.statics;
  for (auto body = bodies.begin(); body != bodies.end(); ++body) {
    const bool is_moved = IsMoved(*body, original.world);
    for (auto other = bodies.begin(); other != bodies.end(); ++other) {
      // Of two that were moved, once.
      const bool is_pair =
          is_moved && other != body && (other > body || !IsMoved(*other, original.world));
      if (!is_pair || !Touch(*body, *other)) continue;
      if (!Touched(original.world, body->name, other->name)) {
        overlaps.push_back({body->name, other->name});
      }
    }
    if (!Touch(robot_shapes_B, varied.X_MB, *body)) continue;
    const StaticBody* before = Find(original.world, body->name);
    if (before == nullptr || !Touch(robot_shapes_B, original.X_MB, *before)) {
      overlaps.push_back({robot, body->name});
    }
  }
  return overlaps;
}

}  // namespace hires::lab
