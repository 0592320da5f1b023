#include "hires/manipulation/collision_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "manipulation/collision_shapes.h"
#include "manipulation/robot_parts.h"

namespace hires::manipulation {

/// A shape of the world that stands still.
struct Thing {
  std::string name;
  std::shared_ptr<const CollisionShape> shape;
  PlacedCollisionShape placed;
};

/// A shape that a link carries.
struct Carried {
  std::string name;
  int link;
  std::shared_ptr<const CollisionShape> shape;
  Eigen::Isometry3d X_LO;
};

namespace {

using NamePair = std::pair<std::string, std::string>;

NamePair Ordered(const std::string& a, const std::string& b) {
  NamePair pair(base::ToLower(a), base::ToLower(b));
  if (pair.second < pair.first) std::swap(pair.first, pair.second);
  return pair;
}

Thing MakeThing(const std::string& name, const geometry::Collision& collision,
                const geometry::Pose3& X_MO, double padding, const std::string& what) {
  Thing thing{name, nullptr, {}};
  thing.shape = std::make_shared<CollisionShape>(MakeCollisionShape(collision, padding, what));
  Place(*thing.shape, ToIsometry(X_MO), &thing.placed);
  return thing;
}

}  // namespace

std::string ToString(const Touch& touch) { return touch.a + " touches " + touch.b; }

/// Shared by clones.
struct Fixed {
  std::shared_ptr<const world::World> world;
  std::shared_ptr<const robot::Robot> robot;
  CollisionParams params;
  RobotParts robot_parts;
  int base;
  std::vector<Thing> statics;
};

/// Everything in place for one posture.
struct Placement {
  std::vector<Eigen::Isometry3d> X_ML;
  std::vector<PlacedCollisionShape> parts, carried;
  std::vector<const Thing*> near;  // statics and loose objects around what moves
};

struct CollisionScene::Impl {
  std::shared_ptr<const Fixed> fixed;
  std::vector<Thing> loose;
  std::vector<Carried> carried;
  std::set<NamePair> allowed;
  mutable Placement now;  // scratch: one instance belongs to one thread

  Eigen::Isometry3d RootPose(const geometry::Pose2& X_MB,
                             const robot::JointPositions& posture) const;
  void AddObject(const world::ObjectState& object, const std::vector<Eigen::Isometry3d>& X_ML);
  int LinkIndex(const world::ObjectState& object) const;
  void PlaceAll(const geometry::Pose2& X_MB, const robot::JointPositions& posture,
                const LinkMask& links) const;
  void FindNear(const LinkMask& links) const;
  bool IsAllowed(const std::string& a, const std::string& b) const;
  /// May the thing touch a link that is rigidly joined to this one?
  bool IsAllowedOnBodyOf(const std::string& thing, int link) const;
  const std::string& NameOfPart(int part) const;

  std::optional<Touch> AmongParts(const LinkMask& links) const;
  std::optional<Touch> PartsAndThings(const LinkMask& links) const;
  std::optional<Touch> CarriedAndParts(const LinkMask& links) const;
  std::optional<Touch> CarriedAndThings(const LinkMask& links) const;
  std::optional<Touch> AmongCarried(const LinkMask& links) const;
  std::optional<Touch> TouchOfFloor(const LinkMask& links) const;
  std::optional<Touch> Find(const LinkMask& links) const;
  /// Do they touch and must not?
  bool Disturb(const std::string& a, const PlacedCollisionShape& shape_a, const std::string& b,
               const PlacedCollisionShape& shape_b, double padding) const {
    return AreTouching(shape_a, shape_b, padding) && !IsAllowed(a, b);
  }
};

Eigen::Isometry3d CollisionScene::Impl::RootPose(const geometry::Pose2& X_MB,
                                                 const robot::JointPositions& posture) const {
  std::vector<Eigen::Isometry3d> X_RL;
  const Eigen::Isometry3d X = ToIsometry(geometry::Lift(X_MB));
  if (fixed->base == 0) return X;
  fixed->robot_parts.tree().Compute(posture, &X_RL);
  return X * X_RL[fixed->base].inverse();
}

int CollisionScene::Impl::LinkIndex(const world::ObjectState& object) const {
  const robot::RobotModel& model = fixed->robot->model;
  const auto link = model.FindLink(object.attached_to);
  if (link) return *link;
  throw base::ConfigError(
      fmt::format("object '{}' is attached to a link of robot '{}': {}", object.name, model.name,
                  base::UnknownName("link", object.attached_to, model.LinkNames())));
}

void CollisionScene::Impl::AddObject(const world::ObjectState& object,
                                     const std::vector<Eigen::Isometry3d>& X_ML) {
  const auto model = fixed->world->ModelOf(object);
  const std::string what = fmt::format("object '{}'", object.name);
  for (const geometry::Collision& collision : model->collisions) {
    Thing thing = MakeThing(object.name, collision, object.X_MO, fixed->params.padding, what);
    if (object.attached_to.empty()) {
      loose.push_back(std::move(thing));
      continue;
    }
    const int link = LinkIndex(object);
    carried.push_back(
        {object.name, link, thing.shape, X_ML[link].inverse() * ToIsometry(object.X_MO)});
  }
}

bool CollisionScene::Impl::IsAllowed(const std::string& a, const std::string& b) const {
  return allowed.count(Ordered(a, b)) > 0;
}

bool CollisionScene::Impl::IsAllowedOnBodyOf(const std::string& thing, int link) const {
  const RobotParts& robot = fixed->robot_parts;
  for (int i = 0; i < robot.tree().size(); ++i) {
    if (robot.RigidGroup(i) != robot.RigidGroup(link)) continue;
    if (IsAllowed(thing, fixed->robot->model.links[i].name)) return true;
  }
  return false;
}

const std::string& CollisionScene::Impl::NameOfPart(int part) const {
  return fixed->robot->model.links[fixed->robot_parts.parts()[part].link].name;
}

void CollisionScene::Impl::PlaceAll(const geometry::Pose2& X_MB,
                                    const robot::JointPositions& posture,
                                    const LinkMask& links) const {
  fixed->robot_parts.PlaceAll(RootPose(X_MB, posture), posture, &now.X_ML, &now.parts);
  now.carried.resize(carried.size());
  for (std::size_t i = 0; i < carried.size(); ++i) {
    Place(*carried[i].shape, now.X_ML[carried[i].link] * carried[i].X_LO, &now.carried[i]);
  }
  FindNear(links);
}

void CollisionScene::Impl::FindNear(const LinkMask& links) const {
  // FCL's own broad phases put a sphere around a turned shape, which for a wall is the whole room.
  PlacedCollisionShape all;
  all.lower.setConstant(1e300);
  all.upper.setConstant(-1e300);
  const auto include = [&](const PlacedCollisionShape& shape) {
    all.lower = all.lower.cwiseMin(shape.lower);
    all.upper = all.upper.cwiseMax(shape.upper);
  };
  const auto& parts = fixed->robot_parts.parts();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (links[parts[i].link]) include(now.parts[i]);
  }
  for (std::size_t i = 0; i < carried.size(); ++i) {
    if (links[carried[i].link]) include(now.carried[i]);
  }
  all.lower.array() -= fixed->params.padding;
  all.upper.array() += fixed->params.padding;
  now.near.clear();
  const auto add_near = [&](const Thing& thing) {
    if ((thing.placed.lower.array() <= all.upper.array()).all() &&
        (all.lower.array() <= thing.placed.upper.array()).all()) {
      now.near.push_back(&thing);
    }
  };
  for (const Thing& thing : fixed->statics) add_near(thing);
  for (const Thing& thing : loose) add_near(thing);
}

std::optional<Touch> CollisionScene::Impl::AmongParts(const LinkMask& links) const {
  const auto& parts = fixed->robot_parts.parts();
  for (const RobotParts::Pair& pair : fixed->robot_parts.pairs()) {
    if (!links[parts[pair.a].link] && !links[parts[pair.b].link]) continue;
    if (!AreTouchingShrunk(now.parts[pair.a], now.parts[pair.b], pair.level)) continue;
    const std::string &a = NameOfPart(pair.a), &b = NameOfPart(pair.b);
    if (!IsAllowed(a, b)) return Touch{a, b};
  }
  return std::nullopt;
}

std::optional<Touch> CollisionScene::Impl::PartsAndThings(const LinkMask& links) const {
  const auto& parts = fixed->robot_parts.parts();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!links[parts[i].link]) continue;
    for (const Thing* thing : now.near) {
      const std::string& name = NameOfPart(static_cast<int>(i));
      if (Disturb(name, now.parts[i], thing->name, thing->placed, fixed->params.padding)) {
        return Touch{name, thing->name};
      }
    }
  }
  return std::nullopt;
}

std::optional<Touch> CollisionScene::Impl::CarriedAndParts(const LinkMask& links) const {
  const auto& parts = fixed->robot_parts.parts();
  for (std::size_t c = 0; c < carried.size(); ++c) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (!links[carried[c].link] && !links[parts[i].link]) continue;
      if (fixed->robot_parts.tree().IsBelow(parts[i].link, carried[c].link)) continue;
      const std::string& name = NameOfPart(static_cast<int>(i));
      if (!Disturb(carried[c].name, now.carried[c], name, now.parts[i], fixed->params.padding)) {
        continue;
      }
      // What stands on the tray keeps no distance from what lies just below it.
      if (IsAllowedOnBodyOf(carried[c].name, parts[i].link) &&
          !AreTouching(now.carried[c], now.parts[i], 0.0)) {
        continue;
      }
      return Touch{carried[c].name, name};
    }
  }
  return std::nullopt;
}

std::optional<Touch> CollisionScene::Impl::CarriedAndThings(const LinkMask& links) const {
  for (std::size_t c = 0; c < carried.size(); ++c) {
    if (!links[carried[c].link]) continue;
    for (const Thing* thing : now.near) {
      if (Disturb(carried[c].name, now.carried[c], thing->name, thing->placed,
                  fixed->params.padding)) {
        return Touch{carried[c].name, thing->name};
      }
    }
  }
  return std::nullopt;
}

std::optional<Touch> CollisionScene::Impl::AmongCarried(const LinkMask& links) const {
  for (std::size_t a = 0; a < carried.size(); ++a) {
    for (std::size_t b = a + 1; b < carried.size(); ++b) {
      if (carried[a].link == carried[b].link) continue;
      if (!links[carried[a].link] && !links[carried[b].link]) continue;
      if (Disturb(carried[a].name, now.carried[a], carried[b].name, now.carried[b],
                  fixed->params.padding)) {
        return Touch{carried[a].name, carried[b].name};
      }
    }
  }
  return std::nullopt;
}

std::optional<Touch> CollisionScene::Impl::TouchOfFloor(const LinkMask& links) const {
  const double floor = fixed->params.padding;
  const auto& parts = fixed->robot_parts.parts();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const int link = parts[i].link;
    if (!links[link] || fixed->robot_parts.stands_on_floor(link)) continue;
    const std::string& name = NameOfPart(static_cast<int>(i));
    if (now.parts[i].lower.z() < floor && !IsAllowed(name, "floor")) return Touch{name, "floor"};
  }
  for (std::size_t c = 0; c < carried.size(); ++c) {
    if (!links[carried[c].link] || now.carried[c].lower.z() >= floor) continue;
    if (!IsAllowed(carried[c].name, "floor")) return Touch{carried[c].name, "floor"};
  }
  return std::nullopt;
}

std::optional<Touch> CollisionScene::Impl::Find(const LinkMask& links) const {
  if (auto touch = PartsAndThings(links)) return touch;
  if (auto touch = CarriedAndThings(links)) return touch;
  if (auto touch = AmongParts(links)) return touch;
  if (auto touch = CarriedAndParts(links)) return touch;
  if (auto touch = AmongCarried(links)) return touch;
  return TouchOfFloor(links);
}

CollisionScene::CollisionScene(std::shared_ptr<const world::World> world,
                               std::shared_ptr<const robot::Robot> robot,
                               const CollisionParams& params)
    : impl_(std::make_unique<Impl>()) {
  HIRES_CHECK(params.padding >= 0.0 && params.num_samples >= 0, "nothing negative");
  const int base = robot->model.FindLink(robot->profile.base_link).value_or(0);
  auto fixed = std::make_shared<Fixed>(Fixed{
      world, robot, params, RobotParts(*robot, params.padding, params.num_samples), base, {}});
  for (const world::StaticBody& body : world->statics) {
    const std::string what = fmt::format("static body '{}'", body.name);
    for (const geometry::Collision& collision : body.collisions) {
      fixed->statics.push_back(MakeThing(body.name, collision, body.X_MB, params.padding, what));
    }
  }
  impl_->fixed = std::move(fixed);
}
CollisionScene::CollisionScene(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
CollisionScene::~CollisionScene() = default;
CollisionScene::CollisionScene(CollisionScene&&) noexcept = default;

CollisionScene CollisionScene::Clone() const {
  auto impl = std::make_unique<Impl>(*impl_);
  impl->now = {};
  return CollisionScene(std::move(impl));
}

void CollisionScene::SetObjects(const std::vector<world::ObjectState>& objects,
                                const geometry::Pose2& X_MB, const robot::JointPositions& posture) {
  impl_->loose.clear();
  impl_->carried.clear();
  const Eigen::Isometry3d X_MR = impl_->RootPose(X_MB, posture);
  std::vector<Eigen::Isometry3d> X_ML;
  impl_->fixed->robot_parts.tree().Compute(posture, &X_ML);
  for (Eigen::Isometry3d& X : X_ML) X = X_MR * X;
  for (const world::ObjectState& object : objects) impl_->AddObject(object, X_ML);
}

void CollisionScene::Allow(const std::string& part, const std::string& other) {
  impl_->allowed.insert(Ordered(part, other));
}

std::optional<Touch> CollisionScene::FindTouch(const geometry::Pose2& X_MB,
                                               const robot::JointPositions& posture) const {
  return FindTouch(X_MB, posture, LinkMask(impl_->fixed->robot->model.links.size(), true));
}

std::optional<Touch> CollisionScene::FindTouch(const geometry::Pose2& X_MB,
                                               const robot::JointPositions& posture,
                                               const LinkMask& links) const {
  HIRES_CHECK(links.size() == impl_->fixed->robot->model.links.size(), "one entry per link");
  impl_->PlaceAll(X_MB, posture, links);
  return impl_->Find(links);
}

LinkMask CollisionScene::MovedBy(const std::vector<std::string>& joints) const {
  const LinkTree& tree = impl_->fixed->robot_parts.tree();
  LinkMask mask(tree.size(), false);
  for (const std::string& joint : joints) {
    const int moved = tree.JointLink(joint);
    for (int i = moved; i < tree.size(); ++i) mask[i] = mask[i] || tree.IsBelow(i, moved);
  }
  return mask;
}

std::vector<std::pair<std::string, std::string>> CollisionScene::LeftOutPairs() const {
  const auto& links = impl_->fixed->robot->model.links;
  std::vector<std::pair<std::string, std::string>> names;
  for (const auto& [a, b] : impl_->fixed->robot_parts.left_out()) {
    names.emplace_back(links[a].name, links[b].name);
  }
  return names;
}

}  // namespace hires::manipulation
