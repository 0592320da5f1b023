#include "hires/physics/physics_world.h"

#include <fmt/format.h>
#include <ode/ode.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "physics/collision_pieces.h"
#include "physics/ode_session.h"
#include "physics/physics_world_impl.h"

namespace hires::physics {
namespace {

using detail::BodyEntry;
using detail::BodyKind;
using detail::Group;
using detail::LooseBody;
using detail::LooseShape;
using detail::NearList;
using detail::ToEigen;
using Eigen::Matrix3d;
using Eigen::Vector3d;

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

}  // namespace

PhysicsWorld::Impl::Impl(const PhysicsParams& params_in) : params(params_in), groups(1) {
  RequireParams(params);
  EnsureOdeIsReady();
  threading.reset(dThreadingAllocateSelfThreadedImplementation());
  world.reset(dWorldCreate());
  dWorldSetStepThreadingImplementation(
      world.get(), dThreadingImplementationGetFunctions(threading.get()), threading.get());
  dWorldSetGravity(world.get(), 0.0, 0.0, -params.gravity);
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
                                     const geometry::Pose3& X_GB, BodyId body, Group* group) {
  for (std::size_t i = 0; i < collisions.size(); ++i) {
    const geometry::Pose3 X_GS = X_GB * collisions[i].X_BS;
    for (const geometry::Collision& piece : PiecesOf(collisions[i])) {
      group->fixtures.push_back({PlacedShape(piece), X_GS.translation,
                                 X_GS.rotation.toRotationMatrix(),
                                 geometry::BoundsOf(piece.shape, X_GS), body, static_cast<int>(i)});
    }
  }
  geometry::Aabb all;
  for (const Fixture& fixture : group->fixtures) all.Include(fixture.bounds_G);
  group->p_GMiddle = 0.5 * (all.lower + all.upper);
  group->radius = group->fixtures.empty() ? 0.0 : 0.5 * (all.upper - all.lower).norm();
}

LooseBody PhysicsWorld::Impl::MakeLoose(const geometry::MassProperties& properties,
                                        const std::vector<geometry::Collision>& collisions) {
  LooseBody body;
  body.p_BC = properties.p_BBcm;
  body.mass = properties.mass;
  body.I_B = properties.I_BBcm;
  for (const geometry::Collision& collision : collisions) {
    const Vector3d p_CS = collision.X_BS.translation - body.p_BC;
    const Matrix3d R_BS = collision.X_BS.rotation.normalized().toRotationMatrix();
    const std::vector<geometry::Collision> pieces = PiecesOf(collision);
    if (pieces.size() > 1) {  // as of a mesh that is whole
      const geometry::Aabb bounds = geometry::BoundsOf(collision.shape, {});
      body.inside = std::max(body.inside, (bounds.upper - bounds.lower).minCoeff() / 4);
    }
    for (const geometry::Collision& piece : pieces) {
      PlacedShape shape(piece);
      body.reach = std::max(body.reach, p_CS.norm() + shape.reach());
      body.inside = std::max(body.inside, shape.inside());
      body.shapes.push_back({std::move(shape), p_CS, R_BS});
    }
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
  Wake(body);
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
  group->p_WMiddle = state.X_WB.translation + group->R_WG * group->p_GMiddle;
  ++group->num_moves;
}

BodyState PhysicsWorld::Impl::LooseState(const LooseBody& body) const {
  if (body.held) return HeldState(body);
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
  const BodyId id = static_cast<BodyId>(impl_->entries.size());
  impl_->AddFixtures(collisions, X_WB, id, &impl_->groups[0]);
  impl_->static_poses.push_back(X_WB);
  return impl_->AddEntry(BodyKind::kStatic, static_cast<int>(impl_->static_poses.size()) - 1);
}

BodyId PhysicsWorld::AddFloor(double friction) {
  geometry::Aabb half_space;
  half_space.lower = Vector3d::Constant(-1e300);
  half_space.upper = {1e300, 1e300, 0.0};
  impl_->groups[0].fixtures.push_back({PlacedShape::Floor(friction), Vector3d::Zero(),
                                       Matrix3d::Identity(), half_space,
                                       static_cast<BodyId>(impl_->entries.size())});
  impl_->static_poses.emplace_back();
  return impl_->AddEntry(BodyKind::kStatic, static_cast<int>(impl_->static_poses.size()) - 1);
}

BodyId PhysicsWorld::AddDriven(const std::vector<geometry::Collision>& collisions,
                               const geometry::Pose3& X_WB) {
  Group group;
  group.is_static = false;
  group.body = static_cast<BodyId>(impl_->entries.size());
  impl_->AddFixtures(collisions, geometry::Pose3(), group.body, &group);
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
  body.id = static_cast<BodyId>(impl_->entries.size());
  impl_->loose.push_back(std::move(body));
  return impl_->AddEntry(BodyKind::kLoose, static_cast<int>(impl_->loose.size()) - 1);
}

void PhysicsWorld::SetMotion(BodyId driven, const BodyState& state) {
  impl_->SetDriven(state, &impl_->DrivenAt(driven));
}

void PhysicsWorld::SetState(BodyId loose, const BodyState& state) {
  HIRES_CHECK(!IsHeld(loose), fmt::format("body {} is held; let it go first", loose));
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
  if (acceleration.isZero(0.0)) return;
  for (LooseBody& body : impl_->loose) impl_->Wake(&body);
}

void PhysicsWorld::Step() {
  EnsureOdeIsReady();
  Impl& impl = *impl_;
  impl.PlaceAllLoose();
  impl.WakeTouched();
  impl.FindAllContacts();
  impl.NoteReached();
  impl.num_contacts = static_cast<int>(impl.contacts.size());
  impl.MoveLoose();
  impl.NoteBroken();
  impl.MoveDriven();
  for (LooseBody* body : impl.awake) body->is_canonical = false;
  impl.RestWhatCan();
  ++impl.num_steps;
}

std::uint64_t PhysicsWorld::num_steps() const { return impl_->num_steps; }
int PhysicsWorld::num_contacts() const { return impl_->num_contacts; }

std::optional<BodyId> PhysicsWorld::broken() const {
  return impl_->broken < 0 ? std::nullopt : std::make_optional(impl_->broken);
}

PhysicsState PhysicsWorld::Save() {
  PhysicsState state;
  for (BodyId id = 0; id < static_cast<BodyId>(impl_->entries.size()); ++id) {
    state.bodies.push_back(GetState(id));
  }
  for (const LooseBody& body : impl_->loose) {
    if (body.held) state.held.push_back(*body.held);
    if (body.is_resting) state.resting.push_back(body.id);
    if (body.is_reached) state.reached.push_back(body.id);
  }
  state.broken = impl_->broken;
  Restore(state);
  return state;
}

void PhysicsWorld::Restore(const PhysicsState& state) {
  HIRES_CHECK(state.bodies.size() == impl_->entries.size(),
              fmt::format("the state has {} bodies, the world {}", state.bodies.size(),
                          impl_->entries.size()));
  for (BodyId id = 0; id < static_cast<BodyId>(impl_->entries.size()); ++id) {
    const BodyEntry& entry = impl_->entries[id];
    if (entry.kind == BodyKind::kLoose) {
      LooseBody& body = impl_->loose[entry.index];
      impl_->Release(state.bodies[id], &body);
      body.is_reached = false;
    }
    if (entry.kind == BodyKind::kDriven) {
      impl_->SetDriven(state.bodies[id], &impl_->groups[entry.index]);
    }
  }
  for (const HeldBody& held : state.held) impl_->Grip(held, &impl_->LooseAt(held.loose));
  for (const BodyId id : state.reached) impl_->LooseAt(id).is_reached = true;
  for (const BodyId id : state.resting) impl_->Rest(&impl_->LooseAt(id));
  impl_->broken = state.broken;
}

std::vector<std::string> PhysicsWorld::TakeSolverMessages() { return TakeOdeMessages(); }

const PhysicsParams& PhysicsWorld::params() const { return impl_->params; }

}  // namespace hires::physics
