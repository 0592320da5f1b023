#pragma once

#include <Eigen/Core>
#include <vector>

namespace hires::physics {

/// Where an unknown of a boxed problem lies.
enum class Place : char { kLower, kBetween, kUpper };

/// n unknown impulses x that give k components of velocity, and what they are asked for:
/// w = A x - b, A = J M^-1 J^T + softness I. Each x_i lies within its bounds, and either at the
/// lower one with w_i >= 0, at the upper one with w_i <= 0, or between them with w_i = 0. There is
/// exactly one such x.
struct BoxedLcp {
  Eigen::MatrixXd JT;            ///< k x n
  Eigen::MatrixXd mass;          ///< k x k, M; symmetric, positive definite
  Eigen::MatrixXd inverse_mass;  ///< k x k
  double softness{0.0};          ///< positive
  Eigen::VectorXd b;             ///< n
  Eigen::VectorXd lower;         ///< n bounds or -infinity, none above `upper`; equal ones give x
  Eigen::VectorXd upper;         ///< n bounds, infinity where there is none
};

/// Solves it by block principal pivoting [Judice and Pires 1994, Computers and Operations Research
/// 21:587-596]: all unknowns in a wrong place change it at once; where that goes round in circles,
/// by an active-set descent. What lies on the border of two places by no more than rounding is
/// right in both, so that ties do no harm.
/// @param places  n guesses; at the end the places of the solution.
/// @param x       the solution.
/// @returns false if the numbers are so far apart that rounding leaves nothing.
bool Solve(const BoxedLcp& problem, std::vector<Place>* places, Eigen::VectorXd* x);

}  // namespace hires::physics
