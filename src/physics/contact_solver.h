#pragma once

#include <Eigen/Core>
#include <vector>

namespace hires::physics {

/// A body as a step's contacts see it. World frame.
struct SolverBody {
  Eigen::Vector3d p_WC;     ///< [m] its centre of mass
  Eigen::Vector3d v, w;     ///< [m/s], [rad/s] what they were after the step without contacts
  double mass{0.0};         ///< [kg] zero where nothing moves it
  Eigen::Matrix3d inertia;  ///< [kg m^2] about C
  Eigen::Vector3d impulse, turning;  ///< result: [N s], [N m s] of all contacts, about C
};

/// A point at which a body touches another one, or something that is as heavy as the world.
struct SolverContact {
  Eigen::Vector3d position;       ///< [m]
  Eigen::Vector3d normal;         ///< unit, into `body`
  Eigen::Vector3d along, across;  ///< unit, in the contact plane
  double friction{0.0};           ///< coefficient, finite
  /// [m/s] Velocity of `body` against `other` that the contact wants along normal, along, across.
  Eigen::Vector3d wanted{Eigen::Vector3d::Zero()};
  bool slips{false};       ///< `along` is where it slips to; else any direction
  int body{0}, other{-1};  ///< indices; -1: nothing moves it
};

/// Finds the impulses of a step's contacts as dWorldStep does with dContactApprox1: they push and
/// never pull; each of both components of friction is at most the coefficient times what the
/// contact would push without friction. Two bodies that do not slip yet have no direction to slip
/// to: along what it takes to stick, the friction of their contacts together is at most the sum.
/// @param softness  [1/kg] added to the velocity that an impulse gives (ODE's CFM by the time
/// step);
///                  positive.
/// @returns false where no solution was found; then the bodies' results mean nothing.
bool SolveContacts(const std::vector<SolverContact>& contacts, double softness,
                   std::vector<SolverBody>* bodies);

}  // namespace hires::physics
