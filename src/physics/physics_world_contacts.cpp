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
/// A push below this does not say where a body will tip [m/s].
constexpr double kNoLean = 1e-6;

/// [m/s] of the body's material point at p_W at the start of the step.
Vector3d StartVelocity(const LooseBody& body, const Vector3d& p_W) {
  return ToEigen(dBodyGetLinearVel(body.ode)) + body.w.cross(p_W - body.p_WC);
}

double SquaredDistance(const geometry::Aabb& bounds, const Vector3d& p) {
  return (bounds.lower - p).cwiseMax(p - bounds.upper).cwiseMax(0.0).squaredNorm();
}

/// Whether the group's body holds the held one.
bool IsGrip(const HeldBody& held, const Group& group) {
  return group.body == held.driven ||
         std::find(held.grip.begin(), held.grip.end(), group.body) != held.grip.end();
}

}  // namespace

void PhysicsWorld::Impl::PlaceLoose(LooseBody* body) {
  const Matrix3d R_WB = body->R_WB = RotationOf(body->ode);
  body->p_WC = ToEigen(dBodyGetPosition(body->ode));
  body->v = ToEigen(dBodyGetLinearVel(body->ode));
  body->w = ToEigen(dBodyGetAngularVel(body->ode));
  // Friction and contact points depend on the slip that gravity and shaking cause in the step.
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
  const double friction = std::min(shape.friction(), other.friction());
  const double restitution = std::max(shape.restitution(), other.restitution());
  for (const ContactPoint& point : found) {
    Vector3d approach = StartVelocity(*body, point.position);
    approach -= other_body != nullptr ? StartVelocity(*other_body, point.position)
                                      : other_velocity(point.position);
    const double wanted = WantedNormalSpeed(point.depth, restitution, point.normal.dot(approach));
    AddContact(point, other_velocity(point.position), wanted, friction, body, other_body);
  }
}

double PhysicsWorld::Impl::WantedNormalSpeed(double depth, double restitution,
                                             double approach) const {
  const double excess = std::max(0.0, depth - params.surface_layer);
  const double repair =
      std::min(params.erp / params.time_step * excess, params.max_correcting_velocity);
  if (restitution <= 0.0 || -approach <= params.restitution_threshold) return repair;
  return std::max(repair, -restitution * approach);
}

void PhysicsWorld::Impl::AddContact(const ContactPoint& point, const Vector3d& v_other,
                                    double wanted_speed, double friction, LooseBody* body,
                                    LooseBody* other_body) {
  fastest_surface2 = std::max(fastest_surface2, v_other.squaredNorm());
  if (other_body != nullptr) {
    const Vector3d v_body = body->v + body->w.cross(point.position - body->p_WC);
    fastest_surface2 = std::max(fastest_surface2, v_body.squaredNorm());
  }
  SolverContact contact;
  contact.position = point.position;
  contact.normal = point.normal;
  contact.wanted = wanted_speed * point.normal;
  if (other_body == nullptr) contact.wanted += v_other;
  contact.friction = friction;
  contact.body = static_cast<int>(body - loose.data());
  if (other_body != nullptr) contact.other = static_cast<int>(other_body - loose.data());
  contacts.push_back(contact);
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
  const PlacedShape& own = body->shapes.front().shape;
  const double restitution = std::max(own.restitution(), fixture->shape.restitution());
  // It comes up to the surface and no farther, or bounces from there.
  const double wanted = closing > params.restitution_threshold && restitution > 0.0
                            ? restitution * closing
                            : -gap / time_step;
  const ContactPoint point{body->p_WC - body->inside * ray.normal, ray.normal, 0.0};
  AddContact(point, group.VelocityAt(point.position), wanted,
             std::min(own.friction(), fixture->shape.friction()), body, nullptr);
}

}  // namespace hires::physics
