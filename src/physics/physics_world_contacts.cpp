// Which shapes touch, and what ODE is told about it.
#include <algorithm>
#include <cmath>

#include "physics/physics_world_impl.h"

namespace hires::physics {
namespace {

using detail::Fixture;
using detail::Group;
using detail::LooseBody;
using detail::LooseShape;
using detail::NearList;
using detail::RotationOf;
using detail::ToEigen;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// How far a loose body may go before its list of near shapes is made again [m]. A wider
/// margin makes longer lists, a narrower one makes them more often.
constexpr double kNearMargin = 0.1;
/// Slip below this has no direction worth following [m/s].
constexpr double kNoSlip = 1e-9;
/// A push below this does not say where a body will tip [m/s].
constexpr double kNoLean = 1e-6;

double SquaredDistance(const geometry::Aabb& bounds, const Vector3d& p) {
  return (bounds.lower - p).cwiseMax(p - bounds.upper).cwiseMax(0.0).squaredNorm();
}

/// A direction in the contact plane: along the slip, or any one where there is none.
Vector3d FrictionDirection(const Vector3d& slip, const Vector3d& normal) {
  const Vector3d tangential = slip - normal * normal.dot(slip);
  const double speed = tangential.norm();
  if (speed > kNoSlip) return tangential / speed;
  const Vector3d any = std::abs(normal.x()) < 0.7 ? Vector3d::UnitX() : Vector3d::UnitY();
  return (any - normal * normal.dot(any)).normalized();
}

/// Whether the group's body holds the held one.
bool IsGrip(const HeldBody& held, const Group& group) {
  return group.body == held.driven ||
         std::find(held.grip.begin(), held.grip.end(), group.body) != held.grip.end();
}

void CopyTo(dReal* to, const Vector3d& from) {
  for (int i = 0; i < 3; ++i) to[i] = from[i];
}

}  // namespace

void PhysicsWorld::Impl::PlaceLoose(LooseBody* body) {
  const Matrix3d R_WB = RotationOf(body->ode);
  body->p_WC = ToEigen(dBodyGetPosition(body->ode));
  body->v = ToEigen(dBodyGetLinearVel(body->ode));
  body->w = ToEigen(dBodyGetAngularVel(body->ode));
  // What gravity and shaking will do during the step belongs to the slip that friction works on.
  if (!body->held)
    body->v += params.time_step * (acceleration + Vector3d(0.0, 0.0, -params.gravity));
  for (LooseShape& at : body->shapes) {
    at.shape.Place(body->p_WC + R_WB * at.p_CS, R_WB * at.R_BS);
  }
}

void PhysicsWorld::Impl::PlaceAllLoose() {
  for (LooseBody& body : loose) {
    if (body.is_resting) continue;
    if (body.held) SetLoose(HeldState(body), &body);
    PlaceLoose(&body);
  }
}

void PhysicsWorld::Impl::FindAllContacts() {
  contacts.clear();
  is_pile = false;
  fastest_surface2 = 0.0;
  touches.clear();
  awake.clear();
  for (LooseBody& body : loose) {
    if (body.is_resting) continue;
    awake.push_back(&body);
    for (std::size_t g = 0; g < groups.size(); ++g) TouchGroup(static_cast<int>(g), &body);
  }
  for (std::size_t b = 1; b < awake.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) TouchLoose(awake[a], awake[b]);
  }
}

void PhysicsWorld::Impl::NoteTouch(const LooseBody& body, BodyId other, double friction) {
  Touch touch{body.id, other, Vector3d::Zero(), Vector3d::UnitZ(), -1.0, friction};
  for (const ContactPoint& point : found) {
    touch.position += point.position / found.size();
    if (point.depth <= touch.depth) continue;
    touch.depth = point.depth;
    touch.normal = point.normal;
  }
  for (Touch& known : touches) {
    if (known.loose != touch.loose || known.other != touch.other) continue;
    if (touch.depth > known.depth) known = touch;  // of several pairs of shapes the deepest
    return;
  }
  touches.push_back(touch);
}

void PhysicsWorld::Impl::MakeNearList(const Group& group, const Vector3d& p_GC,
                                      const LooseBody& body, NearList* near) const {
  near->is_valid = true;
  near->p_GC = p_GC;
  near->fixtures.clear();
  const double distance = body.reach + 2.0 * kNearMargin;
  for (std::size_t i = 0; i < group.fixtures.size(); ++i) {
    if (SquaredDistance(group.fixtures[i].bounds_G, p_GC) <= distance * distance) {
      near->fixtures.push_back(static_cast<int>(i));
    }
  }
}

void PhysicsWorld::Impl::TouchGroup(int index, LooseBody* body) {
  Group& group = groups[index];
  if (!group.is_static) {
    const double far = body->reach + group.radius + kNearMargin;
    if ((body->p_WC - group.p_WMiddle).squaredNorm() > far * far) return;
    if (body->held && IsGrip(*body->held, group)) return;
  }
  const Vector3d p_GC = group.is_static
                            ? body->p_WC
                            : group.R_WG.transpose() * (body->p_WC - group.motion.X_WB.translation);
  NearList& near = body->near[index];
  if (!near.is_valid || (p_GC - near.p_GC).squaredNorm() > kNearMargin * kNearMargin) {
    MakeNearList(group, p_GC, *body, &near);
  }
  if (near.fixtures.empty()) return;
  const Vector3d v_rel = body->v - group.VelocityAt(body->p_WC);
  const Vector3d lean = v_rel.squaredNorm() < kNoLean * kNoLean ? Vector3d::Zero() : v_rel;
  const double way = v_rel.norm() * params.time_step;
  const bool is_fast = way > 0.5 * body->inside;
  const double reach = body->reach + (is_fast ? std::min(way, kNearMargin) : 0.0);
  for (const int i : near.fixtures) {
    Fixture& fixture = group.fixtures[i];
    if (SquaredDistance(fixture.bounds_G, p_GC) > reach * reach) continue;
    const bool touches = TouchFixture(group, lean, &fixture, body);
    if (is_fast && !body->held && !touches && !body->shapes.empty())
      CatchFast(group, v_rel, &fixture, body);
  }
}

void PhysicsWorld::Impl::PlaceFixture(const Group& group, Fixture* fixture) const {
  if (fixture->placed_at == group.num_moves) return;
  fixture->shape.Place(group.motion.X_WB.translation + group.R_WG * fixture->p_GS,
                       group.R_WG * fixture->R_GS);
  fixture->placed_at = group.num_moves;
}

bool PhysicsWorld::Impl::TouchFixture(const Group& group, const Vector3d& lean, Fixture* fixture,
                                      LooseBody* body) {
  PlaceFixture(group, fixture);
  const Vector3d correction = group.ChordCorrection(body->p_WC, params.time_step);
  bool touches = false;
  for (LooseShape& at : body->shapes) {
    FindContacts(at.shape, fixture->shape, lean, &found);
    if (found.empty()) continue;
    touches = true;
    NoteTouch(*body, fixture->body, std::min(at.shape.friction(), fixture->shape.friction()));
    if (body->held) continue;
    AddContacts(at.shape, fixture->shape, body, nullptr, [&](const Vector3d& p_W) -> Vector3d {
      if (group.is_static) return Vector3d::Zero();
      return group.VelocityAt(p_W) + correction;
    });
  }
  return touches;
}

void PhysicsWorld::Impl::TouchLoose(LooseBody* a, LooseBody* b) {
  const double reach = a->reach + b->reach;
  if ((a->p_WC - b->p_WC).squaredNorm() > reach * reach) return;
  Vector3d lean = a->v - b->v;
  if (lean.squaredNorm() < kNoLean * kNoLean) lean.setZero();
  for (LooseShape& at_a : a->shapes) {
    for (LooseShape& at_b : b->shapes) {
      const double shapes_reach = at_a.shape.reach() + at_b.shape.reach();
      if ((at_a.shape.position() - at_b.shape.position()).squaredNorm() >
          shapes_reach * shapes_reach) {
        continue;
      }
      FindContacts(at_a.shape, at_b.shape, lean, &found);
      if (found.empty()) continue;
      NoteTouch(*a, b->id, std::min(at_a.shape.friction(), at_b.shape.friction()));
      if (a->held && b->held) continue;
      AddContacts(at_a.shape, at_b.shape, a, b, [b](const Vector3d& p_W) -> Vector3d {
        return b->v + b->w.cross(p_W - b->p_WC);
      });
    }
  }
}

template <typename SurfaceVelocity>
void PhysicsWorld::Impl::AddContacts(const PlacedShape& shape, const PlacedShape& other,
                                     LooseBody* body, LooseBody* other_body,
                                     const SurfaceVelocity& other_velocity) {
  dContact contact = ContactOf(shape, other, other_body != nullptr);
  for (const ContactPoint& point : found) {
    AddContact(point, other_velocity(point.position), 0.0, body, other_body, &contact);
  }
}

dContact PhysicsWorld::Impl::ContactOf(const PlacedShape& shape, const PlacedShape& other,
                                       bool is_other_loose) const {
  dContact contact;
  contact.surface.mode = dContactFDir1 | dContactApprox1;
  contact.surface.mu = std::min(shape.friction(), other.friction());
  contact.surface.bounce = std::max(shape.restitution(), other.restitution());
  contact.surface.bounce_vel = params.restitution_threshold;
  if (contact.surface.bounce > 0.0) contact.surface.mode |= dContactBounce;
  if (!is_other_loose) {
    contact.surface.mode |= dContactMotionN | dContactMotion1 | dContactMotion2;
  }
  contact.geom.g1 = contact.geom.g2 = nullptr;
  contact.geom.side1 = contact.geom.side2 = -1;
  return contact;
}

void PhysicsWorld::Impl::AddContact(const ContactPoint& point, const Vector3d& v_other,
                                    double closing_speed, LooseBody* body, LooseBody* other_body,
                                    dContact* contact) {
  const Vector3d v_body = body->v + body->w.cross(point.position - body->p_WC);
  const Vector3d slip = v_body - v_other;
  fastest_surface2 = std::max(fastest_surface2, v_other.squaredNorm());
  if (other_body != nullptr) fastest_surface2 = std::max(fastest_surface2, v_body.squaredNorm());
  const Vector3d along = FrictionDirection(slip, point.normal);
  contact->surface.motionN = v_other.dot(point.normal) - closing_speed;
  contact->surface.motion1 = v_other.dot(along);
  contact->surface.motion2 = v_other.dot(point.normal.cross(along));
  CopyTo(contact->geom.pos, point.position);
  CopyTo(contact->geom.normal, point.normal);
  contact->geom.depth = point.depth;
  CopyTo(contact->fdir1, along);
  const int index = static_cast<int>(body - loose.data());
  const int other = other_body == nullptr ? -1 : static_cast<int>(other_body - loose.data());
  contacts.push_back({*contact, index, other, point.normal.cross(slip).norm()});
  is_pile = is_pile || (other >= 0 && !body->held && !other_body->held);
}

void PhysicsWorld::Impl::CatchFast(const Group& group, const Vector3d& v_rel, Fixture* fixture,
                                   LooseBody* body) {
  const double speed = v_rel.norm(), time_step = params.time_step;
  const Vector3d direction = v_rel / speed;
  const RayHit ray =
      CastRay(body->p_WC, direction, speed * time_step + body->inside, fixture->shape);
  if (!ray.hit) return;
  const double gap = -ray.distance * direction.dot(ray.normal) - body->inside;
  const double closing = -v_rel.dot(ray.normal);
  if (gap <= 0.0 || closing * time_step <= gap) return;
  dContact contact = ContactOf(body->shapes.front().shape, fixture->shape, false);
  // ODE bounces from the speed that exceeds the closing speed; what counts is the whole.
  const double closing_speed = gap / time_step;
  contact.surface.bounce =
      (closing_speed + contact.surface.bounce * closing) / (closing - closing_speed);
  const ContactPoint point{body->p_WC - body->inside * ray.normal, ray.normal, 0.0};
  AddContact(point, group.VelocityAt(point.position), closing_speed, body, nullptr, &contact);
}

}  // namespace hires::physics
