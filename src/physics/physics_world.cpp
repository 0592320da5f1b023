#include "hires/physics/physics_world.h"

#include <fmt/format.h>
#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/physics/ode_session.h"
#include "hires/physics/placed_shape.h"

namespace hires::physics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// How far a loose body may go before its list of near shapes is made anew [m]. Longer lists
/// against more frequent making: anything from 0.05 to 0.5 costs the same.
constexpr double kNearMargin = 0.1;
/// Slip below this has no direction worth following [m/s].
constexpr double kNoSlip = 1e-9;
/// A push below this does not say where a body will tip [m/s].
constexpr double kNoLean = 1e-6;

/// What a step's constraints are softened to, one after the other, when ODE cannot solve them.
constexpr std::array<double, 3> kSofterCfm = {1e-7, 1e-6, 1e-5};

/// A shape of a static or driven body in its group's frame G.
struct Fixture {
  PlacedShape shape;
  Vector3d p_GS;
  Matrix3d R_GS;
  geometry::Aabb bounds_G;
  std::uint64_t placed_at{0};  // the group's num_moves for which shape stands in the world
};

/// Shapes that move together: all static ones (G is the world), or those of one driven body.
struct Group {
  bool is_static{true};
  BodyState motion;
  Matrix3d R_WG{Matrix3d::Identity()};
  std::uint64_t num_moves{1};
  std::vector<Fixture> fixtures;  // by body, then by place in the body

  /// Velocity of the group's material point at p_W [m/s].
  Vector3d VelocityAt(const Vector3d& p_W) const {
    return motion.V_WB.linear + motion.V_WB.angular.cross(p_W - motion.X_WB.translation);
  }

  /// What to add for a body that rides at p_W, so that a step takes it along the chord of its arc:
  /// the tangent would let it creep outwards. The same for all contacts of the body, which cannot
  /// shrink as the chords of its points would have it.
  Vector3d ChordCorrection(const Vector3d& p_W, double time_step) const {
    const Vector3d& w = motion.V_WB.angular;
    return 0.5 * time_step * w.cross(w.cross(p_W - motion.X_WB.translation));
  }
};

/// The shapes of one group that a loose body can reach while its centre of mass C stays within
/// kNearMargin of p_GC: a superset, so that how it came about never shows in the contacts.
struct NearList {
  bool is_valid{false};
  Vector3d p_GC{Vector3d::Zero()};
  std::vector<int> fixtures;
};

struct LooseShape {
  PlacedShape shape;
  Vector3d p_CS;
  Matrix3d R_BS;
};

struct LooseBody {
  dBodyID ode;
  Vector3d p_BC;
  std::vector<LooseShape> shapes;
  double reach{0.0};           // no point is farther from C [m]
  double inside{0.0};          // radius of a ball within the thickest shape [m]
  std::vector<NearList> near;  // by group
  bool is_canonical{false};    // `state` is what ODE's numbers were made of
  BodyState state;

  Vector3d p_WC, v, w;  // at the start of the step
};

/// ODE's own numbers of a body.
struct RawState {
  dVector3 position, linear, angular;
  dQuaternion rotation;
};

enum class BodyKind { kStatic, kDriven, kLoose };
struct BodyEntry {
  BodyKind kind;
  int index;  // of the group or of the loose body
};

double SquaredDistance(const geometry::Aabb& bounds, const Vector3d& p) {
  return (bounds.lower - p).cwiseMax(p - bounds.upper).cwiseMax(0.0).squaredNorm();
}

void RequireBetween(const char* name, double value, double lower, double upper,
                    const char* advice) {
  if (value >= lower && value <= upper) return;
  throw base::ConfigError(fmt::format("physics parameter {} is {}, wanted {} to {}; {}", name,
                                      value, lower, upper, advice));
}

void RequireParams(const PhysicsParams& params) {
  RequireBetween("time_step [s]", params.time_step, 1e-5, 0.005, "0.001 suits the tray");
  RequireBetween("gravity [m/s^2]", params.gravity, 0.0, 100.0, "the Earth's is 9.81");
  RequireBetween("erp", params.erp, 0.0, 1.0, "0.2 suits the tray");
  RequireBetween("cfm", params.cfm, 1e-12, 1.0, "1e-8 suits the tray");
  RequireBetween("surface_layer [m]", params.surface_layer, 0.0, 0.1, "0.001 suits the tray");
  RequireBetween("max_correcting_velocity [m/s]", params.max_correcting_velocity, 0.0, 1e6,
                 "100 suits the tray");
  RequireBetween("restitution_threshold [m/s]", params.restitution_threshold, 0.0, 100.0,
                 "0.01 suits the tray");
}

bool IsUsable(const BodyState& state) {
  return state.X_WB.IsFinite() && state.V_WB.linear.allFinite() && state.V_WB.angular.allFinite() &&
         std::abs(state.X_WB.rotation.norm() - 1.0) < 1e-6;
}

Vector3d ToEigen(const dReal* v) { return {v[0], v[1], v[2]}; }

Matrix3d RotationOf(dBodyID body) {
  const dReal* r = dBodyGetRotation(body);
  Matrix3d R;
  R << r[0], r[1], r[2], r[4], r[5], r[6], r[8], r[9], r[10];
  return R;
}

Eigen::Quaterniond TurnBy(const Vector3d& angle_vector) {
  const double angle = angle_vector.norm();
  if (angle == 0.0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, angle_vector / angle));
}

void SetMass(dBodyID body, const geometry::MassProperties& properties) {
  const Matrix3d& I = properties.I_BBcm;
  dMass mass;
  dMassSetParameters(&mass, properties.mass, 0, 0, 0, I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2),
                     I(1, 2));
  dBodySetMass(body, &mass);
}

/// A direction in the contact plane: along the slip, or any one where there is none.
Vector3d FrictionDirection(const Vector3d& slip, const Vector3d& normal) {
  const Vector3d tangential = slip - normal * normal.dot(slip);
  const double speed = tangential.norm();
  if (speed > kNoSlip) return tangential / speed;
  const Vector3d any = std::abs(normal.x()) < 0.7 ? Vector3d::UnitX() : Vector3d::UnitY();
  return (any - normal * normal.dot(any)).normalized();
}

void CopyTo(dReal* to, const Vector3d& from) {
  for (int i = 0; i < 3; ++i) to[i] = from[i];
}

/// Contacts and the integration step of ODE in one owner each.
struct Deleters {
  void operator()(dxWorld* world) const { dWorldDestroy(world); }
  void operator()(dxJointGroup* group) const { dJointGroupDestroy(group); }
  void operator()(dxThreadingImplementation* threading) const {
    dThreadingFreeImplementation(threading);
  }
};

}  // namespace

struct PhysicsWorld::Impl {
  explicit Impl(const PhysicsParams& params_in);

  BodyId AddEntry(BodyKind kind, int index);
  void AddFixtures(const std::vector<geometry::Collision>& collisions, const geometry::Pose3& X_GB,
                   Group* group);
  LooseBody MakeLoose(const geometry::MassProperties& properties,
                      const std::vector<geometry::Collision>& collisions);
  void ForgetNear();
  Group& DrivenAt(BodyId id);
  LooseBody& LooseAt(BodyId id);
  const BodyEntry& At(BodyId id) const;

  void SetLoose(const BodyState& state, LooseBody* body);
  void SetDriven(const BodyState& state, Group* group);
  BodyState LooseState(const LooseBody& body) const;

  void PlaceLoose(LooseBody* body);
  void TouchGroup(int group, LooseBody* body);
  /// True if they touch.
  bool TouchFixture(const Group& group, const Vector3d& lean, Fixture* fixture, LooseBody* body);
  void TouchLoose(LooseBody* a, LooseBody* b);
  void MakeNearList(const Group& group, const Vector3d& p_GC, const LooseBody& body,
                    NearList* near) const;
  /// Lets a body that would pass through a shape within this step come up to it and no farther.
  void CatchFast(const Group& group, const Vector3d& v_rel, Fixture* fixture, LooseBody* body);
  dContact ContactOf(const PlacedShape& shape, const PlacedShape& other, bool is_other_loose) const;
  /// `closing_speed` is what the normal velocity may be at most towards the other body [m/s].
  void AddContact(const ContactPoint& point, const Vector3d& v_other, double closing_speed,
                  LooseBody* body, LooseBody* other_body, dContact* contact);
  template <typename SurfaceVelocity>
  void AddContacts(const PlacedShape& shape, const PlacedShape& other, LooseBody* body,
                   LooseBody* other_body, const SurfaceVelocity& other_velocity);
  void MoveLoose();
  void KeepRaw();
  void PutRawBack();
  void MoveDriven();

  PhysicsParams params;
  Vector3d acceleration{Vector3d::Zero()};  // extra, of loose bodies
  std::uint64_t num_steps{0};
  int num_contacts{0};
  std::unique_ptr<dxThreadingImplementation, Deleters> threading;  // outlives the world
  std::unique_ptr<dxWorld, Deleters> world;
  std::unique_ptr<dxJointGroup, Deleters> joints;
  std::vector<BodyEntry> entries;  // by BodyId
  std::vector<Group> groups;       // 0 is the static one
  std::vector<LooseBody> loose;
  std::vector<RawState> raw;  // of the loose bodies, at the start of the step
  std::vector<geometry::Pose3> static_poses;
  ContactList found;
};

PhysicsWorld::Impl::Impl(const PhysicsParams& params_in) : params(params_in), groups(1) {
  RequireParams(params);
  EnsureOdeIsReady();
  threading.reset(dThreadingAllocateSelfThreadedImplementation());
  world.reset(dWorldCreate());
  joints.reset(dJointGroupCreate(0));
  dWorldSetStepThreadingImplementation(
      world.get(), dThreadingImplementationGetFunctions(threading.get()), threading.get());
  dWorldSetGravity(world.get(), 0.0, 0.0, -params.gravity);
  dWorldSetERP(world.get(), params.erp);
  dWorldSetCFM(world.get(), params.cfm);
  dWorldSetContactSurfaceLayer(world.get(), params.surface_layer);
  dWorldSetContactMaxCorrectingVel(world.get(), params.max_correcting_velocity);
  dWorldSetAutoDisableFlag(world.get(), 0);
}

BodyId PhysicsWorld::Impl::AddEntry(BodyKind kind, int index) {
  entries.push_back({kind, index});
  ForgetNear();
  return static_cast<BodyId>(entries.size()) - 1;
}

void PhysicsWorld::Impl::ForgetNear() {
  for (LooseBody& body : loose) body.near.assign(groups.size(), NearList());
}

void PhysicsWorld::Impl::AddFixtures(const std::vector<geometry::Collision>& collisions,
                                     const geometry::Pose3& X_GB, Group* group) {
  for (const geometry::Collision& collision : collisions) {
    PlacedShape shape(collision);
    const geometry::Pose3 X_GS = X_GB * collision.X_BS;
    group->fixtures.push_back({std::move(shape), X_GS.translation, X_GS.rotation.toRotationMatrix(),
                               geometry::BoundsOf(collision.shape, X_GS)});
  }
}

LooseBody PhysicsWorld::Impl::MakeLoose(const geometry::MassProperties& properties,
                                        const std::vector<geometry::Collision>& collisions) {
  LooseBody body;
  body.p_BC = properties.p_BBcm;
  for (const geometry::Collision& collision : collisions) {
    PlacedShape shape(collision);
    const Vector3d p_CS = collision.X_BS.translation - body.p_BC;
    body.reach = std::max(body.reach, p_CS.norm() + shape.reach());
    body.inside = std::max(body.inside, shape.inside());
    body.shapes.push_back(
        {std::move(shape), p_CS, collision.X_BS.rotation.normalized().toRotationMatrix()});
  }
  return body;
}

const BodyEntry& PhysicsWorld::Impl::At(BodyId id) const {
  HIRES_CHECK(id >= 0 && id < static_cast<BodyId>(entries.size()),
              fmt::format("body {} does not exist, there are {}", id, entries.size()));
  return entries[id];
}

Group& PhysicsWorld::Impl::DrivenAt(BodyId id) {
  HIRES_CHECK(At(id).kind == BodyKind::kDriven, fmt::format("body {} is not driven", id));
  return groups[At(id).index];
}

LooseBody& PhysicsWorld::Impl::LooseAt(BodyId id) {
  HIRES_CHECK(At(id).kind == BodyKind::kLoose, fmt::format("body {} is not loose", id));
  return loose[At(id).index];
}

void PhysicsWorld::Impl::SetLoose(const BodyState& state, LooseBody* body) {
  HIRES_CHECK(IsUsable(state), "the state of a loose body is finite, its rotation of unit length");
  body->state = state;
  body->is_canonical = true;
  const Eigen::Quaterniond& q = state.X_WB.rotation;
  const Vector3d p_BC_W = q * body->p_BC;
  const Vector3d p = state.X_WB.translation + p_BC_W;
  const Vector3d& w = state.V_WB.angular;
  const Vector3d v = state.V_WB.linear + w.cross(p_BC_W);
  const dQuaternion rotation = {q.w(), q.x(), q.y(), q.z()};
  dBodySetPosition(body->ode, p.x(), p.y(), p.z());
  dBodySetQuaternion(body->ode, rotation);
  dBodySetLinearVel(body->ode, v.x(), v.y(), v.z());
  dBodySetAngularVel(body->ode, w.x(), w.y(), w.z());
  dBodySetForce(body->ode, 0.0, 0.0, 0.0);
  dBodySetTorque(body->ode, 0.0, 0.0, 0.0);
}

void PhysicsWorld::Impl::SetDriven(const BodyState& state, Group* group) {
  HIRES_CHECK(IsUsable(state), "the state of a driven body is finite, its rotation of unit length");
  group->motion = state;
  group->R_WG = state.X_WB.rotation.toRotationMatrix();
  ++group->num_moves;
}

BodyState PhysicsWorld::Impl::LooseState(const LooseBody& body) const {
  if (body.is_canonical) return body.state;
  const dReal* q = dBodyGetQuaternion(body.ode);
  BodyState state;
  state.X_WB.rotation = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
  const Vector3d p_BC_W = state.X_WB.rotation * body.p_BC;
  state.X_WB.translation = ToEigen(dBodyGetPosition(body.ode)) - p_BC_W;
  state.V_WB.angular = ToEigen(dBodyGetAngularVel(body.ode));
  state.V_WB.linear = ToEigen(dBodyGetLinearVel(body.ode)) - state.V_WB.angular.cross(p_BC_W);
  return state;
}

void PhysicsWorld::Impl::PlaceLoose(LooseBody* body) {
  const Matrix3d R_WB = RotationOf(body->ode);
  body->p_WC = ToEigen(dBodyGetPosition(body->ode));
  body->v = ToEigen(dBodyGetLinearVel(body->ode));
  body->w = ToEigen(dBodyGetAngularVel(body->ode));
  // What gravity and shaking will do during the step belongs to the slip that friction works on.
  body->v += params.time_step * (acceleration + Vector3d(0.0, 0.0, -params.gravity));
  for (LooseShape& at : body->shapes) {
    at.shape.Place(body->p_WC + R_WB * at.p_CS, R_WB * at.R_BS);
  }
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
    if (is_fast && !touches && !body->shapes.empty()) CatchFast(group, v_rel, &fixture, body);
  }
}

bool PhysicsWorld::Impl::TouchFixture(const Group& group, const Vector3d& lean, Fixture* fixture,
                                      LooseBody* body) {
  if (fixture->placed_at != group.num_moves) {
    fixture->shape.Place(group.motion.X_WB.translation + group.R_WG * fixture->p_GS,
                         group.R_WG * fixture->R_GS);
    fixture->placed_at = group.num_moves;
  }
  const Vector3d correction = group.ChordCorrection(body->p_WC, params.time_step);
  bool touches = false;
  for (LooseShape& at : body->shapes) {
    FindContacts(at.shape, fixture->shape, lean, &found);
    if (found.empty()) continue;
    touches = true;
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
  const Vector3d slip = body->v + body->w.cross(point.position - body->p_WC) - v_other;
  const Vector3d along = FrictionDirection(slip, point.normal);
  contact->surface.motionN = v_other.dot(point.normal) - closing_speed;
  contact->surface.motion1 = v_other.dot(along);
  contact->surface.motion2 = v_other.dot(point.normal.cross(along));
  CopyTo(contact->geom.pos, point.position);
  CopyTo(contact->geom.normal, point.normal);
  contact->geom.depth = point.depth;
  CopyTo(contact->fdir1, along);
  const dJointID joint = dJointCreateContact(world.get(), joints.get(), contact);
  dJointAttach(joint, body->ode, other_body == nullptr ? nullptr : other_body->ode);
  ++num_contacts;
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

/// ODE's solver gives up on a step now and then (about one in 100,000 at the brink of sliding and
/// tipping) and leaves friction out. Slightly softer constraints get it over the tie.
void PhysicsWorld::Impl::MoveLoose() {
  const std::size_t num_messages = NumOdeMessages();
  KeepRaw();
  dWorldStep(world.get(), params.time_step);
  for (const double cfm : kSofterCfm) {
    if (NumOdeMessages() == num_messages) break;
    ForgetOdeMessages(num_messages);
    PutRawBack();
    dWorldSetCFM(world.get(), std::max(cfm, params.cfm));
    dWorldStep(world.get(), params.time_step);
    dWorldSetCFM(world.get(), params.cfm);
  }
}

void PhysicsWorld::Impl::KeepRaw() {
  raw.resize(loose.size());
  for (std::size_t i = 0; i < loose.size(); ++i) {
    dBodyCopyPosition(loose[i].ode, raw[i].position);
    dBodyCopyQuaternion(loose[i].ode, raw[i].rotation);
    std::copy_n(dBodyGetLinearVel(loose[i].ode), 3, raw[i].linear);
    std::copy_n(dBodyGetAngularVel(loose[i].ode), 3, raw[i].angular);
  }
}

void PhysicsWorld::Impl::PutRawBack() {
  for (std::size_t i = 0; i < loose.size(); ++i) {
    const RawState& at = raw[i];
    dBodySetPosition(loose[i].ode, at.position[0], at.position[1], at.position[2]);
    dBodySetQuaternion(loose[i].ode, at.rotation);
    dBodySetLinearVel(loose[i].ode, at.linear[0], at.linear[1], at.linear[2]);
    dBodySetAngularVel(loose[i].ode, at.angular[0], at.angular[1], at.angular[2]);
  }
}

void PhysicsWorld::Impl::MoveDriven() {
  for (Group& group : groups) {
    if (group.is_static) continue;
    BodyState moved = group.motion;
    if (moved.V_WB.linear.isZero(0.0) && moved.V_WB.angular.isZero(0.0)) continue;
    moved.X_WB.translation += params.time_step * moved.V_WB.linear;
    moved.X_WB.rotation =
        (TurnBy(params.time_step * moved.V_WB.angular) * moved.X_WB.rotation).normalized();
    SetDriven(moved, &group);
  }
}

PhysicsWorld::PhysicsWorld(const PhysicsParams& params) : impl_(std::make_unique<Impl>(params)) {}
PhysicsWorld::~PhysicsWorld() = default;

BodyId PhysicsWorld::AddStatic(const std::vector<geometry::Collision>& collisions,
                               const geometry::Pose3& X_WB) {
  HIRES_CHECK(X_WB.IsFinite(), "the pose of a static body is finite");
  impl_->AddFixtures(collisions, X_WB, &impl_->groups[0]);
  impl_->static_poses.push_back(X_WB);
  return impl_->AddEntry(BodyKind::kStatic, static_cast<int>(impl_->static_poses.size()) - 1);
}

BodyId PhysicsWorld::AddFloor(double friction) {
  geometry::Aabb half_space;
  half_space.lower = Vector3d::Constant(-1e300);
  half_space.upper = {1e300, 1e300, 0.0};
  impl_->groups[0].fixtures.push_back(
      {PlacedShape::Floor(friction), Vector3d::Zero(), Matrix3d::Identity(), half_space});
  impl_->static_poses.emplace_back();
  return impl_->AddEntry(BodyKind::kStatic, static_cast<int>(impl_->static_poses.size()) - 1);
}

BodyId PhysicsWorld::AddDriven(const std::vector<geometry::Collision>& collisions,
                               const geometry::Pose3& X_WB) {
  Group group;
  group.is_static = false;
  impl_->AddFixtures(collisions, geometry::Pose3(), &group);
  impl_->SetDriven({X_WB, {}}, &group);
  impl_->groups.push_back(std::move(group));
  return impl_->AddEntry(BodyKind::kDriven, static_cast<int>(impl_->groups.size()) - 1);
}

BodyId PhysicsWorld::AddLoose(const geometry::MassProperties& mass_properties,
                              const std::vector<geometry::Collision>& collisions,
                              const BodyState& state) {
  const std::string wrong = geometry::WhyUnphysical(mass_properties);
  if (!wrong.empty()) {
    throw base::ConfigError(fmt::format(
        "loose body{}: {}", collisions.empty() ? "" : " with '" + collisions[0].name + "'", wrong));
  }
  HIRES_CHECK(IsUsable(state), "the state of a loose body is finite, its rotation of unit length");
  EnsureOdeIsReady();
  LooseBody body = impl_->MakeLoose(mass_properties, collisions);
  body.ode = dBodyCreate(impl_->world.get());
  SetMass(body.ode, mass_properties);
  impl_->SetLoose(state, &body);
  impl_->loose.push_back(std::move(body));
  return impl_->AddEntry(BodyKind::kLoose, static_cast<int>(impl_->loose.size()) - 1);
}

void PhysicsWorld::SetMotion(BodyId driven, const BodyState& state) {
  impl_->SetDriven(state, &impl_->DrivenAt(driven));
}

void PhysicsWorld::SetState(BodyId loose, const BodyState& state) {
  impl_->SetLoose(state, &impl_->LooseAt(loose));
}

BodyState PhysicsWorld::GetState(BodyId body) const {
  const BodyEntry& entry = impl_->At(body);
  switch (entry.kind) {
    case BodyKind::kLoose:
      return impl_->LooseState(impl_->loose[entry.index]);
    case BodyKind::kDriven:
      return impl_->groups[entry.index].motion;
    default:
      return {impl_->static_poses[entry.index], {}};
  }
}

void PhysicsWorld::SetExtraAcceleration(const Vector3d& acceleration) {
  HIRES_CHECK(acceleration.allFinite(), "an acceleration is finite");
  impl_->acceleration = acceleration;
  const Vector3d sum = acceleration + Vector3d(0.0, 0.0, -impl_->params.gravity);
  dWorldSetGravity(impl_->world.get(), sum.x(), sum.y(), sum.z());
}

void PhysicsWorld::Step() {
  EnsureOdeIsReady();
  Impl& impl = *impl_;
  impl.num_contacts = 0;
  for (LooseBody& body : impl.loose) impl.PlaceLoose(&body);
  for (LooseBody& body : impl.loose) {
    for (std::size_t g = 0; g < impl.groups.size(); ++g) {
      impl.TouchGroup(static_cast<int>(g), &body);
    }
  }
  for (std::size_t b = 1; b < impl.loose.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) impl.TouchLoose(&impl.loose[a], &impl.loose[b]);
  }
  impl.MoveLoose();
  dJointGroupEmpty(impl.joints.get());
  impl.MoveDriven();
  for (LooseBody& body : impl.loose) body.is_canonical = false;
  ++impl.num_steps;
}

std::uint64_t PhysicsWorld::num_steps() const { return impl_->num_steps; }
int PhysicsWorld::num_contacts() const { return impl_->num_contacts; }

PhysicsState PhysicsWorld::Save() {
  PhysicsState state;
  for (BodyId id = 0; id < static_cast<BodyId>(impl_->entries.size()); ++id) {
    state.bodies.push_back(GetState(id));
  }
  Restore(state);
  return state;
}

void PhysicsWorld::Restore(const PhysicsState& state) {
  HIRES_CHECK(state.bodies.size() == impl_->entries.size(),
              fmt::format("the state has {} bodies, the world {}", state.bodies.size(),
                          impl_->entries.size()));
  for (BodyId id = 0; id < static_cast<BodyId>(impl_->entries.size()); ++id) {
    const BodyEntry& entry = impl_->entries[id];
    if (entry.kind == BodyKind::kLoose)
      impl_->SetLoose(state.bodies[id], &impl_->loose[entry.index]);
    if (entry.kind == BodyKind::kDriven) {
      impl_->SetDriven(state.bodies[id], &impl_->groups[entry.index]);
    }
  }
}

std::vector<std::string> PhysicsWorld::TakeSolverMessages() { return TakeOdeMessages(); }

const PhysicsParams& PhysicsWorld::params() const { return impl_->params; }

}  // namespace hires::physics
