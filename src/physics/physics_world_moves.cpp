// Moving loose bodies by the impulses of their contacts.
#include <Eigen/LU>
#include <cmath>

#include "physics/physics_world_impl.h"

namespace hires::physics {
namespace {

using detail::LooseBody;
using detail::ToEigen;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// [J/kg]
double TurningEnergy(const LooseBody& body, const Matrix3d& R_WB, const Vector3d& w_W) {
  const Vector3d w = R_WB.transpose() * w_W;
  return 0.5 * w.dot(body.I_B * w) / body.mass;
}

/// The angular velocity after a step of free motion, as dWorldStep finds it: implicit in the
/// gyroscopic torque [Lacoursiere 2006, Stabilizing gyroscopic forces in rigid multibody
/// simulations].
Vector3d FreeAngularVelocity(const Matrix3d& I_W, const Vector3d& w, double time_step) {
  const Vector3d L = I_W * w;
  Matrix3d A = I_W;
  A.col(0) -= time_step * L.cross(Vector3d::UnitX());
  A.col(1) -= time_step * L.cross(Vector3d::UnitY());
  A.col(2) -= time_step * L.cross(Vector3d::UnitZ());
  return A.inverse() * L;
}

}  // namespace

void PhysicsWorld::Impl::FindFreeBodies() {
  solver_bodies.resize(loose.size());
  for (std::size_t i = 0; i < loose.size(); ++i) {
    const LooseBody& body = loose[i];
    SolverBody& free = solver_bodies[i];
    free.p_WC = body.p_WC;
    free.v = body.v;
    free.w = body.w;
    free.mass = 0.0;
    if (body.held || body.is_resting) continue;
    free.mass = body.mass;
    free.inertia = body.R_WB * body.I_B * body.R_WB.transpose();
    free.w = FreeAngularVelocity(free.inertia, body.w, params.time_step);
  }
}

void PhysicsWorld::Impl::MoveLoose() {
  if (!contacts.empty()) {
    FindFreeBodies();
    SolveContacts(params.cfm / params.time_step, &contacts, &solver_bodies);
    for (std::size_t i = 0; i < loose.size(); ++i) {
      const SolverBody& solved = solver_bodies[i];
      if (solved.mass == 0.0) continue;
      const Vector3d force = solved.impulse / params.time_step;
      const Vector3d torque = solved.torque_impulse / params.time_step;
      dBodyAddForce(loose[i].ode, force.x(), force.y(), force.z());
      dBodyAddTorque(loose[i].ode, torque.x(), torque.y(), torque.z());
    }
  }
  dWorldStep(world.get(), params.time_step);
}

/// Seen from a surface of constant velocity u, no contact with it gives energy; so it gives a body
/// at most u |v' - v| for each of its kilograms, and of all that touch at once none more than the
/// fastest.
void PhysicsWorld::Impl::NoteBroken() {
  if (broken >= 0) return;
  for (const LooseBody& body : loose) {
    if (body.held || body.is_resting) continue;
    const Vector3d v = ToEigen(dBodyGetLinearVel(body.ode)),
                   w = ToEigen(dBodyGetAngularVel(body.ode));
    const double after =
        0.5 * v.squaredNorm() + TurningEnergy(body, detail::RotationOf(body.ode), w);
    if (after <= kUnexplained) continue;
    const double before = 0.5 * body.v.squaredNorm() + TurningEnergy(body, body.R_WB, body.w);
    const double given = std::sqrt(fastest_surface2) * (v - body.v).norm();
    if (after - before - given > kUnexplained) broken = body.id;
  }
}

}  // namespace hires::physics
