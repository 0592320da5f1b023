#include "simulation/hands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::simulation {
namespace {

using Eigen::Vector3d;
using physics::BodyId;
using physics::PhysicsWorld;
using physics::Touch;

constexpr double kSameGap = 1e-6;     // [m] a gap this much wider opens the hand
constexpr double kNoDistance = 1e-4;  // [m] touches this near to each other have no line between
constexpr double kPressed = 0.002;    // [m] held objects may overlap this much before they yield
constexpr double kMostYield = 0.015;  // [m] see Hands

bool IsIn(const std::vector<BodyId>& bodies, BodyId body) {
  return std::find(bodies.begin(), bodies.end(), body) != bodies.end();
}

/// The deepest touch of a loose body with any of some driven ones.
const Touch* FindTouch(const std::vector<Touch>& touches, BodyId loose,
                       const std::vector<BodyId>& fingers) {
  const Touch* deepest = nullptr;
  for (const Touch& touch : touches) {
    if (touch.loose != loose || !IsIn(fingers, touch.other)) continue;
    if (deepest == nullptr || touch.depth > deepest->depth) deepest = &touch;
  }
  return deepest;
}

bool IsSame(const robot::GripperCommand& a, const robot::GripperCommand& b) {
  return a.gap == b.gap && a.max_effort == b.max_effort;
}

Vector3d VelocityOf(const GraspableObject& object, const PhysicsWorld& physics) {
  const physics::BodyState state = physics.GetState(object.body);
  return state.V_WB.linear + state.V_WB.angular.cross(state.X_WB.rotation * object.p_OOcm);
}

}  // namespace

std::vector<BodyId> HandBodies::All() const {
  std::vector<BodyId> all{palm};
  all.insert(all.end(), left_fingers.begin(), left_fingers.end());
  all.insert(all.end(), right_fingers.begin(), right_fingers.end());
  return all;
}

bool IsForceClosure(const Touch& left, const Touch& right) {
  const Vector3d line = right.position - left.position;
  const double length = line.norm();
  if (length < kNoDistance) return false;
  const double friction = std::min(left.friction, right.friction);
  const double least = length / std::sqrt(1.0 + friction * friction);  // cosine of the cone's angle
  return left.normal.dot(line) >= least && right.normal.dot(-line) >= least;
}

double HoldingAcceleration(double force, double friction, double mass) {
  return 2.0 * friction * force / mass;
}

Hands::Hands(std::vector<HandBodies> bodies, double max_force)
    : bodies_(std::move(bodies)), max_force_(max_force), hands_(bodies_.size()) {
  for (Hand& hand : hands_) hand.force = max_force_;
}

int Hands::HolderOf(int object) const {
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    if (hands_[i].object == object) return static_cast<int>(i);
  }
  return -1;
}

void Hands::Send(const std::string& arm, const robot::GripperCommand& command,
                 const std::vector<GraspableObject>& objects, JointDrives* drives,
                 PhysicsWorld* physics) {
  std::vector<std::string> arms;
  for (const HandBodies& bodies : bodies_) arms.push_back(bodies.arm);
  const auto found = std::find(arms.begin(), arms.end(), arm);
  if (found == arms.end()) {
    throw base::ConfigError("gripper command: " + base::UnknownName("arm", arm, arms));
  }
  if (!std::isfinite(command.gap) || !std::isfinite(command.max_effort)) {
    throw base::ConfigError(
        fmt::format("gripper command of '{}': gap {} m, effort {} N; wanted finite numbers", arm,
                    command.gap, command.max_effort));
  }
  const int index = static_cast<int>(found - arms.begin());
  Hand& hand = hands_[index];
  if (hand.command && IsSame(*hand.command, command)) return;  // skills repeat themselves
  hand.command = command;
  hand.has_slipped = false;
  hand.force = command.max_effort < 0.0 ? max_force_ : std::min(command.max_effort, max_force_);
  const int joint = bodies_[index].gap_joint;
  // To its limit it opens even where what it holds has kept it there.
  const bool opens = command.gap > drives->position(joint) + kSameGap ||
                     command.gap >= drives->limits(joint).upper;
  if (hand.object >= 0 && !opens) return;
  if (hand.object >= 0) LetGo(index, objects, physics);
  drives->SendTo(joint, command.gap);
}

void Hands::Hold(int index, int object, double friction,
                 const std::vector<GraspableObject>& objects, PhysicsWorld* physics) {
  Hand& hand = hands_[index];
  HIRES_CHECK(hand.object < 0, "a hand holds one object");
  physics->Hold(objects[object].body, bodies_[index].palm, bodies_[index].All());
  hand.object = object;
  hand.friction = friction;
  hand.yielded = 0.0;
  hand.v_MOcm.reset();
}

void Hands::LetGo(int index, const std::vector<GraspableObject>& objects, PhysicsWorld* physics) {
  Hand& hand = hands_[index];
  physics->LetGo(objects[hand.object].body);
  hand.object = -1;
}

void Hands::React(const std::vector<GraspableObject>& objects, JointDrives* drives,
                  PhysicsWorld* physics) {
  for (int i = 0; i < static_cast<int>(hands_.size()); ++i) {
    if (hands_[i].object < 0) {
      TryGrasp(i, objects, drives, physics);
    } else {
      Yield(i, objects, physics);
      TrySlip(i, objects, physics);
    }
  }
}

void Hands::TryGrasp(int index, const std::vector<GraspableObject>& objects, JointDrives* drives,
                     PhysicsWorld* physics) {
  const HandBodies& bodies = bodies_[index];
  if (hands_[index].has_slipped || drives->velocity(bodies.gap_joint) >= 0.0) return;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Touch* left = FindTouch(physics->touches(), objects[i].body, bodies.left_fingers);
    if (left == nullptr) continue;
    const Touch* right = FindTouch(physics->touches(), objects[i].body, bodies.right_fingers);
    if (right == nullptr || !IsForceClosure(*left, *right)) continue;
    drives->Halt(bodies.gap_joint);
    Hold(index, static_cast<int>(i), std::min(left->friction, right->friction), objects, physics);
    return;
  }
}

void Hands::Yield(int index, const std::vector<GraspableObject>& objects, PhysicsWorld* physics) {
  Hand& hand = hands_[index];
  const BodyId held = objects[hand.object].body;
  for (const Touch& touch : physics->touches()) {
    if ((touch.loose != held && touch.other != held) || touch.depth <= kPressed) continue;
    const double way = touch.depth - kPressed;
    physics->ShiftHeld(held, (touch.loose == held ? way : -way) * touch.normal);
    hand.yielded += way;
    if (hand.yielded <= kMostYield || blocked_) continue;
    blocked_ = Blocked{hand.object, touch.loose == held ? touch.other : touch.loose};
  }
}

void Hands::TrySlip(int index, const std::vector<GraspableObject>& objects, PhysicsWorld* physics) {
  Hand& hand = hands_[index];
  const GraspableObject& object = objects[hand.object];
  const Vector3d v = VelocityOf(object, *physics);
  const std::optional<Vector3d> before = std::exchange(hand.v_MOcm, v);
  if (!before) return;
  const physics::PhysicsParams& params = physics->params();
  const Vector3d needed = (v - *before) / params.time_step + params.gravity * Vector3d::UnitZ();
  if (needed.norm() <= HoldingAcceleration(hand.force, hand.friction, object.mass)) return;
  LetGo(index, objects, physics);
  hand.has_slipped = true;
}

}  // namespace hires::simulation
