#pragma once

#include <Eigen/Core>
#include <vector>

namespace hires::physics {

/// A body at a step's contacts. World frame.
struct SolverBody {
  Eigen::Vector3d p_WC;     ///< [m] centre of mass
  Eigen::Vector3d v, w;     ///< [m/s], [rad/s] at the end of the step if nothing touched it
  double mass{0.0};         ///< [kg]; zero: contacts do not move it
  Eigen::Matrix3d inertia;  ///< [kg m^2] about C
  Eigen::Vector3d impulse, torque_impulse;  ///< result: [N s], [N m s] of all contacts, about C
};

/// A point at which a body touches another body, or a surface that contacts do not move.
struct SolverContact {
  Eigen::Vector3d position;  ///< [m]
  Eigen::Vector3d normal;    ///< unit, into `body`
  /// [m/s] Velocity of `body` relative to `other` at the point: the component along the normal is
  /// the least one allowed, the tangential ones are those without slip.
  Eigen::Vector3d wanted{Eigen::Vector3d::Zero()};
  double friction{0.0};                              ///< coefficient, finite
  int body{0}, other{-1};                            ///< indices; -1: not moved by contacts
  Eigen::Vector3d impulse{Eigen::Vector3d::Zero()};  ///< result: [N s] on `body`
};

/// How the impulses of a step are found.
enum class ContactMethod {
  kNewton,      ///< falls back on kGaussSeidel if it does not converge
  kGaussSeidel  ///< contact after contact, until nothing changes
};

/// Iterations that solving took, over all islands.
struct SolverEffort {
  int newton_rounds{0};
  int bound_rounds{0};  ///< of the convex problems with fixed bounds of friction
  int sweeps{0};        ///< of kGaussSeidel
};

/// Finds the impulses of a step's contacts by Coulomb's law: with impulse p = p_n n + p_t and
/// velocity u relative to `wanted`, u_n + s p_n >= 0, p_n >= 0, one of both zero; |p_t| <= mu p_n;
/// and either p_t = -u_t / s (sticking) or p_t = -mu p_n u_t / |u_t| (sliding). The bound of
/// friction is the normal impulse of the same step, and a sliding contact does not lift off. s is
/// the softness.
///
/// kNewton is a semismooth Newton method on these equations [Alart and Curnier 1991, Computer
/// Methods in Applied Mechanics and Engineering 92:353-375], solved for the velocities of the
/// bodies; each contact is open, sticks, or slides in a direction. The first guess of the states is
/// the motion without contacts. Where that does not converge, guesses come from a few sweeps of
/// kGaussSeidel, then from convex problems whose bounds of friction are the normal impulses before
/// [Haslinger 1983, Mathematical Methods in the Applied Sciences 5:422-437]. kGaussSeidel is the
/// nonsmooth contact dynamics method [Jean 1999, Computer Methods in Applied Mechanics and
/// Engineering 177:235-257]. It may end before it converges; its impulses then still push and stay
/// within the cones. Both methods depend on the arguments alone.
/// @param softness  s [1/kg], positive: ODE's CFM divided by the time step.
SolverEffort SolveContacts(double softness, std::vector<SolverContact>* contacts,
                           std::vector<SolverBody>* bodies,
                           ContactMethod method = ContactMethod::kNewton);

}  // namespace hires::physics
