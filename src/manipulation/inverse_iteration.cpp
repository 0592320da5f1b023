#include "manipulation/inverse_iteration.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

namespace hires::manipulation {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double kBaseDamping = 1e-6;  // keeps the step finite where the arm is singular
constexpr int kPatience = 12;          // iterations without progress before a start is given up
constexpr double kProgress = 0.9;      // the error has to shrink to this share to count as progress

}  // namespace

InverseIteration::InverseIteration(const KDL::Chain& chain, const Eigen::VectorXd& lower,
                                   const Eigen::VectorXd& upper, const InverseParams& params)
    : chain_(chain),
      lower_(lower),
      upper_(upper),
      params_(params),
      forward_(chain_),
      jacobian_solver_(chain_),
      joints_(chain.getNrOfJoints()),
      jacobian_(chain.getNrOfJoints()) {}

Vector6 InverseIteration::ErrorAt(const KDL::Frame& goal) {
  KDL::Frame now;
  forward_.JntToCart(joints_, now);
  const KDL::Twist difference = KDL::diff(now, goal);
  Vector6 error;
  for (int i = 0; i < 6; ++i) error[i] = difference[i];
  return error;
}

bool InverseIteration::IsWithinTolerance(const Vector6& error) const {
  return error.head<3>().norm() <= params_.position_tolerance &&
         error.tail<3>().norm() <= params_.angle_tolerance;
}

bool InverseIteration::HoldPushedJoints(const Eigen::VectorXd& step,
                                        Eigen::MatrixXd* jacobian) const {
  bool is_any_held = false;
  for (Eigen::Index i = 0; i < step.size(); ++i) {
    const double q = joints_(i);
    const bool is_pushed = (q >= upper_[i] && step[i] > 0.0) || (q <= lower_[i] && step[i] < 0.0);
    if (!is_pushed) continue;
    jacobian->col(i).setZero();
    is_any_held = true;
  }
  return is_any_held;
}

Eigen::VectorXd InverseIteration::Step(const Vector6& error) {
  jacobian_solver_.JntToJac(joints_, jacobian_);
  Eigen::MatrixXd J = jacobian_.data;
  const double damping = 0.5 * error.squaredNorm() + kBaseDamping;
  Eigen::VectorXd step;
  for (Eigen::Index held = 0; held <= J.cols(); ++held) {  // each turn holds at least one more
    Eigen::Matrix<double, 6, 6> A = J * J.transpose();
    A.diagonal().array() += damping;
    step = J.transpose() * A.ldlt().solve(error);
    if (!HoldPushedJoints(step, &J)) break;
  }
  return step;
}

std::optional<Eigen::VectorXd> InverseIteration::Run(const KDL::Frame& goal,
                                                     const Eigen::VectorXd& start) {
  joints_.data = start;
  double best = std::numeric_limits<double>::infinity();
  int without_progress = 0;
  for (int i = 0; i < params_.max_iterations && without_progress < kPatience; ++i) {
    const Vector6 error = ErrorAt(goal);
    if (IsWithinTolerance(error)) return joints_.data;
    without_progress = error.norm() < kProgress * best ? 0 : without_progress + 1;
    best = std::min(best, error.norm());
    joints_.data = (joints_.data + Step(error)).cwiseMax(lower_).cwiseMin(upper_);
  }
  return std::nullopt;
}

}  // namespace hires::manipulation
