#include "hires/simulation/pose_error.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "hires/geometry/angles.h"

namespace hires::simulation {
namespace {

using geometry::Pose2;

/// L with L L^T = covariance, which may be singular.
Eigen::Matrix3d RootOf(const Eigen::Matrix3d& covariance) {
  const Eigen::LDLT<Eigen::Matrix3d> ldlt(covariance);
  const Eigen::Vector3d scale = ldlt.vectorD().cwiseMax(0.0).cwiseSqrt();
  const Eigen::Matrix3d lower = ldlt.matrixL();
  return ldlt.transpositionsP().transpose() * (lower * scale.asDiagonal().toDenseMatrix());
}

Eigen::Vector3d VectorOf(const Pose2& X) { return {X.x, X.y, geometry::WrapToPi(X.yaw)}; }

}  // namespace

PoseErrorWalk::PoseErrorWalk(const PoseErrorParams& params, const Pose2& X_MB, base::Rng rng)
    : PoseErrorWalk(params, X_MB, {}, std::move(rng)) {
  error_ = Draw(RootOf(params.start));
}

PoseErrorWalk::PoseErrorWalk(const PoseErrorParams& params, const Pose2& X_MB, const Pose2& error,
                             base::Rng rng)
    : params_(params),
      added_root_(RootOf(params.added)),
      rng_(std::move(rng)),
      stretch_(rng_.Normal(0.0, params.stretch)),
      X_MB_(X_MB),
      error_(error) {}

void PoseErrorWalk::Drive(const Pose2& X_MB) {
  const Pose2 X_AB = X_MB_.Inverse() * X_MB;
  if (X_AB.x == 0.0 && X_AB.y == 0.0 && X_AB.yaw == 0.0) return;
  X_MB_ = X_MB;
  const double root = std::sqrt(X_AB.position().norm());
  Pose2 told = X_AB;
  told.x += stretch_ * X_AB.x + rng_.Normal(0.0, params_.walk * root);
  told.y += stretch_ * X_AB.y + rng_.Normal(0.0, params_.walk * root);
  told.yaw += rng_.Normal(0.0, params_.walk_yaw * root);
  X_OB_ = X_OB_ * told;
  error_ = X_AB.Inverse() * error_ * told;
  const Pose2 moved = X_OBcorrected_.Inverse() * X_OB_;
  if (moved.position().norm() >= params_.update_distance ||
      std::abs(geometry::WrapToPi(moved.yaw)) >= params_.update_turn)
    Correct();
}

void PoseErrorWalk::Correct() {
  X_OBcorrected_ = X_OB_;
  const Eigen::Vector3d kept = params_.kept * VectorOf(error_);
  const Pose2 added = Draw(added_root_);
  error_ = {kept.x() + added.x, kept.y() + added.y, kept.z() + added.yaw};
}

Pose2 PoseErrorWalk::Draw(const Eigen::Matrix3d& root) {
  Eigen::Vector3d scores;
  for (double& score : scores) score = rng_.Normal(0.0, 1.0);
  const Eigen::Vector3d drawn = root * scores;
  return {drawn.x(), drawn.y(), drawn.z()};
}

}  // namespace hires::simulation
