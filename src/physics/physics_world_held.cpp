// Loose bodies that move with a driven one, and driven bodies against static ones.
#include <fmt/format.h>

#include <algorithm>

#include "hires/base/check.h"
#include "physics/physics_world_impl.h"

namespace hires::physics {

using detail::BodyKind;
using detail::Fixture;
using detail::Group;
using detail::LooseBody;
using Eigen::Vector3d;

BodyState PhysicsWorld::Impl::HeldState(const LooseBody& body) const {
  const Group& group = groups[At(body.held->driven).index];
  BodyState state;
  state.X_WB = group.motion.X_WB * body.held->X_DL;
  state.X_WB.rotation.normalize();
  state.V_WB = {group.VelocityAt(state.X_WB.translation), group.motion.V_WB.angular};
  return state;
}

void PhysicsWorld::Impl::Grip(const HeldBody& held, LooseBody* body) {
  Wake(body);
  body->held = held;
  body->is_reached = true;
  dBodySetKinematic(body->ode);
  SetLoose(HeldState(*body), body);
}

void PhysicsWorld::Impl::Release(const BodyState& state, LooseBody* body) {
  if (body->held) dBodySetDynamic(body->ode);
  body->held.reset();
  SetLoose(state, body);
}

std::optional<FixedTouch> PhysicsWorld::Impl::LookForFixedTouch(BodyId except, Group* group) {
  std::optional<FixedTouch> deepest;
  for (Fixture& fixed : groups[0].fixtures) {
    if (fixed.body == except) continue;
    const Vector3d& p = group->p_WMiddle;
    const Vector3d away = (fixed.bounds_G.lower - p).cwiseMax(p - fixed.bounds_G.upper);
    if (away.cwiseMax(0.0).squaredNorm() > group->radius * group->radius) continue;
    PlaceFixture(groups[0], &fixed);
    for (std::size_t i = 0; i < group->fixtures.size(); ++i) {
      Fixture& moved = group->fixtures[i];
      PlaceFixture(*group, &moved);
      const Vector3d& q = moved.shape.position();
      const Vector3d gap = (fixed.bounds_G.lower - q).cwiseMax(q - fixed.bounds_G.upper);
      if (gap.maxCoeff() > moved.shape.reach()) continue;
      FindContacts(moved.shape, fixed.shape, Vector3d::Zero(), &found);
      for (const ContactPoint& point : found) {
        if (deepest && point.depth <= deepest->depth) continue;
        deepest = FixedTouch{moved.collision, fixed.body, point.depth};
      }
    }
  }
  return deepest;
}

void PhysicsWorld::Hold(BodyId loose, BodyId driven, const std::vector<BodyId>& grip) {
  HIRES_CHECK(!IsHeld(loose), fmt::format("body {} is held already", loose));
  for (const BodyId id : grip) impl_->DrivenAt(id);
  const geometry::Pose3 X_WD = impl_->DrivenAt(driven).motion.X_WB;
  geometry::Pose3 X_DL = X_WD.Inverse() * GetState(loose).X_WB;
  X_DL.rotation.normalize();
  impl_->Grip({loose, driven, X_DL, grip}, &impl_->LooseAt(loose));
}

void PhysicsWorld::LetGo(BodyId loose) {
  HIRES_CHECK(IsHeld(loose), fmt::format("body {} is not held", loose));
  impl_->Release(GetState(loose), &impl_->LooseAt(loose));
}

void PhysicsWorld::ShiftHeld(BodyId loose, const Vector3d& way_W) {
  HIRES_CHECK(IsHeld(loose), fmt::format("body {} is not held", loose));
  HIRES_CHECK(way_W.allFinite(), "a shift is finite");
  LooseBody& body = impl_->LooseAt(loose);
  const Group& group = impl_->DrivenAt(body.held->driven);
  body.held->X_DL.translation += group.R_WG.transpose() * way_W;
}

bool PhysicsWorld::IsHeld(BodyId loose) const { return impl_->LooseAt(loose).held.has_value(); }

const std::vector<Touch>& PhysicsWorld::touches() const { return impl_->touches; }

std::vector<Touch> PhysicsWorld::FindTouches() {
  std::vector<Touch> last;
  std::swap(last, impl_->touches);
  impl_->PlaceAllLoose();
  impl_->FindAllContacts();
  std::swap(last, impl_->touches);
  return last;
}

std::optional<FixedTouch> PhysicsWorld::FindFixedTouch(BodyId driven, BodyId except) {
  Group& group = impl_->DrivenAt(driven);
  if (group.asked_at != group.num_moves || group.asked_except != except) {
    group.fixed_touch = impl_->LookForFixedTouch(except, &group);
  }
  group.asked_at = group.num_moves;
  group.asked_except = except;
  return group.fixed_touch;
}

}  // namespace hires::physics
