#pragma once

#include <Eigen/Core>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <optional>

#include "hires/manipulation/arm_kinematics.h"

namespace hires::manipulation {

/// One iteration towards joint positions that bring a chain's end to a frame, started again and
/// again from other positions. Belongs to one thread.
class InverseIteration {
 public:
  InverseIteration(const KDL::Chain& chain, const Eigen::VectorXd& lower,
                   const Eigen::VectorXd& upper, const InverseParams& params);
  InverseIteration(const InverseIteration&) = delete;
  InverseIteration& operator=(const InverseIteration&) = delete;

  /// @param goal  in the frame of the chain's root.
  std::optional<Eigen::VectorXd> Run(const KDL::Frame& goal, const Eigen::VectorXd& start);

 private:
  Eigen::Matrix<double, 6, 1> ErrorAt(const KDL::Frame& goal);
  bool IsWithinTolerance(const Eigen::Matrix<double, 6, 1>& error) const;
  /// The damped step; joints that stand at a limit and would be pushed beyond it stay.
  Eigen::VectorXd Step(const Eigen::Matrix<double, 6, 1>& error);
  bool HoldPushedJoints(const Eigen::VectorXd& step, Eigen::MatrixXd* jacobian) const;

  // KDL's joints remember the last position behind their const functions, and its solvers only
  // refer to the chain: a chain of one's own keeps threads apart.
  KDL::Chain chain_;
  Eigen::VectorXd lower_, upper_;
  InverseParams params_;
  KDL::ChainFkSolverPos_recursive forward_;
  KDL::ChainJntToJacSolver jacobian_solver_;
  KDL::JntArray joints_;
  KDL::Jacobian jacobian_;
};

}  // namespace hires::manipulation
