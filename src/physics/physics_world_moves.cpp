// Moving loose bodies by what their contacts push: by ODE's solver, or by our own.
#include <algorithm>
#include <array>
#include <cmath>

#include "physics/ode_session.h"
#include "physics/physics_world_impl.h"

namespace hires::physics {
namespace {

using detail::LooseBody;
using detail::PlacedContact;
using detail::RawState;
using detail::ToEigen;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// What a step's constraints are softened to, one after the other, when ODE cannot solve them.
constexpr std::array<double, 3> kSofterCfm = {1e-7, 1e-6, 1e-5};

/// Bodies that stick to one another creep as constraints are soft: up to this speed that is no
/// direction to slip to [m/s].
constexpr double kSticking = 1e-6;

Matrix3d InertiaOf(const dMass& mass) {
  Matrix3d I;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) I(row, column) = mass.I[4 * row + column];
  }
  return I;
}

/// [J/kg]
double TurningEnergy(dBodyID body, const dReal* rotation, const Vector3d& w_W) {
  dMass mass;
  dBodyGetMass(body, &mass);
  const Eigen::Quaterniond R_WB(rotation[0], rotation[1], rotation[2], rotation[3]);
  const Vector3d w = R_WB.conjugate() * w_W;
  return 0.5 * w.dot(InertiaOf(mass) * w) / mass.mass;
}

Vector3d VelocityAt(const RawState& body, const dReal* p_W) {
  const Vector3d arm = ToEigen(p_W) - ToEigen(body.position);
  return ToEigen(body.linear) + ToEigen(body.angular).cross(arm);
}

/// The normal velocity that ODE's contact joint wants [m/s].
/// @param approach  normal velocity of the body against the other one at the start of the step
double WantedNormalSpeed(const dContact& contact, double approach, const PhysicsParams& params) {
  const dSurfaceParameters& surface = contact.surface;
  const double motion = (surface.mode & dContactMotionN) != 0 ? surface.motionN : 0.0;
  const double depth = std::max(0.0, contact.geom.depth - params.surface_layer);
  const double repair = params.erp / params.time_step * depth + motion;
  const double wanted = std::min(repair, params.max_correcting_velocity);
  const double impact = motion - approach;
  if ((surface.mode & dContactBounce) == 0 || impact <= surface.bounce_vel) return wanted;
  return std::max(wanted, surface.bounce * impact + motion);
}

SolverContact ContactFor(const PlacedContact& placed, const std::vector<RawState>& raw,
                         const PhysicsParams& params) {
  const dContact& contact = placed.contact;
  SolverContact made;
  made.position = ToEigen(contact.geom.pos);
  made.normal = ToEigen(contact.geom.normal);
  made.along = ToEigen(contact.fdir1);
  made.across = made.normal.cross(made.along);
  made.friction = contact.surface.mu;
  made.body = placed.body;
  made.other = placed.other;
  Vector3d velocity = VelocityAt(raw[placed.body], contact.geom.pos);
  if (placed.other >= 0) velocity -= VelocityAt(raw[placed.other], contact.geom.pos);
  made.wanted[0] = WantedNormalSpeed(contact, velocity.dot(made.normal), params);
  if ((contact.surface.mode & dContactMotion1) != 0) made.wanted[1] = contact.surface.motion1;
  if ((contact.surface.mode & dContactMotion2) != 0) made.wanted[2] = contact.surface.motion2;
  made.slips = placed.slip > kSticking;
  return made;
}

}  // namespace

/// ODE's pivoting ends where two forces reach their bounds at once, and leaves all forces that come
/// later out of the step. That is rare under a single body, where slightly softer constraints get
/// it over the tie; in a pile it happens in every second step.
void PhysicsWorld::Impl::MoveLoose() {
  KeepRaw();
  if (!is_pile || !MoveBySolver()) MoveByOde();
}

void PhysicsWorld::Impl::MoveByOde() {
  const std::size_t num_messages = NumOdeMessages();
  for (const PlacedContact& placed : contacts) {
    const dJointID joint = dJointCreateContact(world.get(), joints.get(), &placed.contact);
    dJointAttach(joint, loose[placed.body].ode,
                 placed.other < 0 ? nullptr : loose[placed.other].ode);
  }
  dWorldStep(world.get(), params.time_step);
  for (const double cfm : kSofterCfm) {
    if (NumOdeMessages() == num_messages) return;
    ForgetOdeMessages(num_messages);
    PutRawBack();
    dWorldSetCFM(world.get(), std::max(cfm, params.cfm));
    dWorldStep(world.get(), params.time_step);
    dWorldSetCFM(world.get(), params.cfm);
  }
}

std::vector<SolverBody> PhysicsWorld::Impl::FreeBodies() {
  dJointGroupEmpty(joints.get());
  dWorldStep(world.get(), params.time_step);
  std::vector<SolverBody> bodies(loose.size());
  for (std::size_t i = 0; i < loose.size(); ++i) {
    bodies[i].v = ToEigen(dBodyGetLinearVel(loose[i].ode));
    bodies[i].w = ToEigen(dBodyGetAngularVel(loose[i].ode));
  }
  PutRawBack();
  for (std::size_t i = 0; i < loose.size(); ++i) {
    bodies[i].p_WC = ToEigen(raw[i].position);
    if (loose[i].held || loose[i].is_resting) continue;
    dMass mass;
    dBodyGetMass(loose[i].ode, &mass);
    const Matrix3d R_WB = detail::RotationOf(loose[i].ode);
    bodies[i].mass = mass.mass;
    bodies[i].inertia = R_WB * InertiaOf(mass) * R_WB.transpose();
  }
  return bodies;
}

bool PhysicsWorld::Impl::MoveBySolver() {
  std::vector<SolverBody> bodies = FreeBodies();
  std::vector<SolverContact> points;
  points.reserve(contacts.size());
  for (const PlacedContact& placed : contacts) points.push_back(ContactFor(placed, raw, params));
  if (!SolveContacts(points, params.cfm / params.time_step, &bodies)) return false;
  for (std::size_t i = 0; i < loose.size(); ++i) {
    if (loose[i].is_resting) continue;
    const Vector3d force = bodies[i].impulse / params.time_step;
    const Vector3d torque = bodies[i].turning / params.time_step;
    dBodyAddForce(loose[i].ode, force.x(), force.y(), force.z());
    dBodyAddTorque(loose[i].ode, torque.x(), torque.y(), torque.z());
  }
  dWorldStep(world.get(), params.time_step);
  return true;
}

void PhysicsWorld::Impl::KeepRaw() {
  raw.resize(loose.size());
  for (std::size_t i = 0; i < loose.size(); ++i) {
    if (loose[i].is_resting) continue;
    dBodyCopyPosition(loose[i].ode, raw[i].position);
    dBodyCopyQuaternion(loose[i].ode, raw[i].rotation);
    std::copy_n(dBodyGetLinearVel(loose[i].ode), 3, raw[i].linear);
    std::copy_n(dBodyGetAngularVel(loose[i].ode), 3, raw[i].angular);
  }
}

void PhysicsWorld::Impl::PutRawBack() {
  for (std::size_t i = 0; i < loose.size(); ++i) {
    if (loose[i].is_resting) continue;
    const RawState& at = raw[i];
    dBodySetPosition(loose[i].ode, at.position[0], at.position[1], at.position[2]);
    dBodySetQuaternion(loose[i].ode, at.rotation);
    dBodySetLinearVel(loose[i].ode, at.linear[0], at.linear[1], at.linear[2]);
    dBodySetAngularVel(loose[i].ode, at.angular[0], at.angular[1], at.angular[2]);
  }
}

/// Seen from a surface of constant velocity u, no contact with it gives energy; so it gives a body
/// at most u |v' - v| for each of its kilograms, and of all that touch at once none more than the
/// fastest.
void PhysicsWorld::Impl::NoteBroken() {
  if (broken >= 0) return;
  for (std::size_t i = 0; i < loose.size(); ++i) {
    const LooseBody& body = loose[i];
    if (body.held || body.is_resting) continue;
    const Vector3d v = ToEigen(dBodyGetLinearVel(body.ode)),
                   w = ToEigen(dBodyGetAngularVel(body.ode));
    const double after =
        0.5 * v.squaredNorm() + TurningEnergy(body.ode, dBodyGetQuaternion(body.ode), w);
    if (after <= kUnexplained) continue;
    const double before =
        0.5 * body.v.squaredNorm() + TurningEnergy(body.ode, raw[i].rotation, body.w);
    const double given = std::sqrt(fastest_surface2) * (v - body.v).norm();
    if (after - before - given > kUnexplained) broken = body.id;
  }
}

}  // namespace hires::physics
