// Loose bodies that rest until something comes to them, and which ones something came to.
#include <algorithm>
#include <cmath>

#include "hires/geometry/angles.h"
#include "physics/physics_world_impl.h"

namespace hires::physics {
namespace {

using detail::BodyKind;
using detail::Fixture;
using detail::Group;
using detail::LooseBody;
using detail::LooseShape;
using detail::ToEigen;
using Eigen::Vector3d;

/// What is slower than this, at its centre and at its farthest point, hardly moves [m/s]. Sinking
/// into the surface layer is slower, what rolls from rest is as fast after 0.1 s on a slope of
/// 0.001.
constexpr double kHardly = 1e-3;
/// [rad] from the vertical: what is held up along a line within this is held up from straight
/// below. A slope of this would give a ball 5 mm/s in a second.
constexpr double kStraight = 1e-3;

/// Whether p lies over the points, over a line between two, or among them. A ball has one point, a
/// cylinder on its side several in a line, a mesh those of a facet.
bool IsOver(const std::vector<Vector3d>& points, const Vector3d& p) {
  std::vector<double> angles;  // [rad] at which they lie around p, seen from above
  for (const Vector3d& from : points) {
    angles.push_back(std::atan2(from.y() - p.y(), from.x() - p.x()));
    for (const Vector3d& to : points) {
      const Eigen::Vector2d along = (to - from).head<2>(), way = (p - from).head<2>();
      const double length2 = along.squaredNorm();
      const double share = length2 > 0.0 ? std::clamp(way.dot(along) / length2, 0.0, 1.0) : 0.0;
      if ((way - share * along).norm() <= kStraight * (p.z() - from.z())) return true;
    }
  }
  std::sort(angles.begin(), angles.end());
  double widest = angles.empty() ? HUGE_VAL : angles.front() + 2.0 * geometry::kPi - angles.back();
  for (std::size_t i = 1; i < angles.size(); ++i)
    widest = std::max(widest, angles[i] - angles[i - 1]);
  return widest < geometry::kPi;
}

}  // namespace

void PhysicsWorld::Impl::Rest(LooseBody* body) {
  BodyState state = LooseState(*body);
  state.V_WB = {};
  SetLoose(state, body);
  PlaceLoose(body);
  body->v = body->w = Vector3d::Zero();
  body->is_resting = true;
  dBodyDisable(body->ode);
}

void PhysicsWorld::Impl::Wake(LooseBody* body) {
  if (!body->is_resting) return;
  body->is_resting = false;
  dBodyEnable(body->ode);
}

bool PhysicsWorld::Impl::IsTouchedByGroup(Group* group, LooseBody* body) {
  const double far = body->reach + group->radius;
  if ((body->p_WC - group->p_WMiddle).squaredNorm() > far * far) return false;
  for (Fixture& fixture : group->fixtures) {
    PlaceFixture(*group, &fixture);
    for (LooseShape& at : body->shapes) {
      const double near = at.shape.reach() + fixture.shape.reach();
      if ((at.shape.position() - fixture.shape.position()).squaredNorm() > near * near) continue;
      FindContacts(at.shape, fixture.shape, Vector3d::Zero(), &found);
      if (!found.empty()) return true;
    }
  }
  return false;
}

bool PhysicsWorld::Impl::IsTouchedBy(LooseBody* other, LooseBody* body) {
  const double reach = other->reach + body->reach;
  if ((other->p_WC - body->p_WC).squaredNorm() > reach * reach) return false;
  for (LooseShape& at : body->shapes) {
    for (LooseShape& other_at : other->shapes) {
      FindContacts(at.shape, other_at.shape, Vector3d::Zero(), &found);
      if (!found.empty()) return true;
    }
  }
  return false;
}

/// Whom one that wakes touches wakes, too: so round after round, until a round wakes none.
void PhysicsWorld::Impl::WakeTouched() {
  awake.clear();
  for (LooseBody& body : loose) {
    if (!body.is_resting) awake.push_back(&body);
  }
  bool is_one_woken = true;
  while (is_one_woken) {
    is_one_woken = false;
    for (LooseBody& body : loose) {
      if (!body.is_resting) continue;
      const bool is_touched =
          std::any_of(groups.begin() + 1, groups.end(),
                      [&](Group& group) { return IsTouchedByGroup(&group, &body); }) ||
          std::any_of(awake.begin(), awake.end(),
                      [&](LooseBody* other) { return IsTouchedBy(other, &body); });
      if (!is_touched) continue;
      Wake(&body);
      PlaceLoose(&body);
      awake.push_back(&body);
      is_one_woken = true;
    }
  }
}

/// By a chain of any length within one step: what is hit may be away in the next one.
void PhysicsWorld::Impl::NoteReached() {
  bool is_one_more = true;
  while (is_one_more) {
    is_one_more = false;
    for (const Touch& touch : touches) {
      LooseBody& body = loose[entries[touch.loose].index];
      const BodyEntry& at = entries[touch.other];
      if (at.kind == BodyKind::kStatic) continue;
      LooseBody* other = at.kind == BodyKind::kLoose ? &loose[at.index] : nullptr;
      const bool is_reached = other == nullptr || body.is_reached || other->is_reached;
      if (!is_reached || (body.is_reached && (other == nullptr || other->is_reached))) continue;
      body.is_reached = true;
      if (other != nullptr) other->is_reached = true;
      is_one_more = true;
    }
  }
}

bool PhysicsWorld::Impl::CanRest(int index) {
  const LooseBody& body = loose[index];
  if (body.held || body.is_reached) return false;
  const Vector3d v = ToEigen(dBodyGetLinearVel(body.ode)),
                 w = ToEigen(dBodyGetAngularVel(body.ode));
  if (v.norm() + body.reach * w.norm() > kHardly) return false;
  below.clear();
  for (const SolverContact& contact : contacts) {
    if (contact.other == index) return false;
    if (contact.body != index) continue;
    if (contact.other >= 0) return false;
    if (contact.normal.z() < std::cos(kStraight)) continue;
    below.push_back(contact.position);
  }
  return IsOver(below, body.p_WC);
}

void PhysicsWorld::Impl::RestWhatCan() {
  if (!acceleration.isZero(0.0)) return;
  for (std::size_t i = 0; i < loose.size(); ++i) {
    LooseBody& body = loose[i];
    if (body.may_rest && !body.is_resting && CanRest(static_cast<int>(i))) Rest(&body);
  }
}

void PhysicsWorld::LetRest(BodyId loose) { impl_->LooseAt(loose).may_rest = true; }

bool PhysicsWorld::IsResting(BodyId loose) const { return impl_->LooseAt(loose).is_resting; }

bool PhysicsWorld::IsReached(BodyId loose) const { return impl_->LooseAt(loose).is_reached; }

}  // namespace hires::physics
