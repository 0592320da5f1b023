#include "hires/localisation/odometry_model.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "hires/geometry/angles.h"

namespace hires::localisation::odometry_model_test {
namespace {

using geometry::Pose2;
using geometry::WrapToPi;

constexpr MotionKind kKinds[] = {MotionKind::kDiff, MotionKind::kOmni, MotionKind::kDiffCorrected,
                                 MotionKind::kOmniCorrected};

OdometryModelParams Alphas(MotionKind kind, double a1, double a2, double a3, double a4, double a5) {
  return {kind, a1, a2, a3, a4, a5};
}

/// Standard deviations of forward, left, yaw around the motion.
Eigen::Vector3d Spread(const OdometryModelParams& params, const Pose2& X_AB) {
  constexpr int kDraws = 20000;
  const MotionSampler sampler(params, X_AB);
  base::Rng rng(5);
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (int i = 0; i < kDraws; ++i) {
    const Pose2 drawn = sampler.Sample(&rng);
    const Eigen::Vector3d off(drawn.x - X_AB.x, drawn.y - X_AB.y, WrapToPi(drawn.yaw - X_AB.yaw));
    squares += off.cwiseProduct(off);
  }
  return (squares / kDraws).cwiseSqrt();
}

TEST(MotionSamplerTest, WithoutNoiseAllModelsGiveTheMotionItself) {
  base::Rng rng(1);
  for (MotionKind kind : kKinds) {
    for (int i = 0; i < 100; ++i) {
      const Pose2 X_OA{rng.Normal(0.0, 5.0), rng.Normal(0.0, 5.0), rng.Uniform(-3.0, 3.0)};
      const Pose2 X_OB{rng.Normal(0.0, 5.0), rng.Normal(0.0, 5.0), rng.Uniform(-3.0, 3.0)};
      const MotionSampler sampler(Alphas(kind, 0, 0, 0, 0, 0), X_OA.Inverse() * X_OB);
      const Pose2 end = X_OA * sampler.Sample(&rng);
      EXPECT_NEAR(end.x, X_OB.x, 1e-9);
      EXPECT_NEAR(end.y, X_OB.y, 1e-9);
      EXPECT_NEAR(WrapToPi(end.yaw - X_OB.yaw), 0.0, 1e-9);
    }
  }
}

TEST(MotionSamplerTest, RobotThatStandsStillStays) {
  base::Rng rng(1);
  for (MotionKind kind : kKinds) {
    const Pose2 drawn = MotionSampler(Alphas(kind, 1, 1, 1, 1, 1), {}).Sample(&rng);
    EXPECT_EQ(drawn.position().norm(), 0.0);
    EXPECT_EQ(WrapToPi(drawn.yaw), 0.0);
  }
}

TEST(MotionSamplerTest, CorrectedModelsTakeAlphasAsVariancesPerSquare) {
  // 2 m straight: forward sqrt(alpha3) * 2, yaw sqrt(alpha2) * 2 (diff: of both turns).
  const Pose2 straight{2.0, 0.0, 0.0};
  const Eigen::Vector3d omni =
      Spread(Alphas(MotionKind::kOmniCorrected, 0, 0.0004, 0.01, 0, 0.0025), straight);
  EXPECT_NEAR(omni[0], 0.2, 0.005);
  EXPECT_NEAR(omni[1], 0.1, 0.0025);
  EXPECT_NEAR(omni[2], 0.04, 0.001);
  const Eigen::Vector3d diff =
      Spread(Alphas(MotionKind::kDiffCorrected, 0, 0.0004, 0.01, 0, 0), straight);
  EXPECT_NEAR(diff[0], 0.2, 0.005);
  EXPECT_NEAR(diff[1], 2.0 * 0.04, 0.002);
  EXPECT_NEAR(diff[2], std::sqrt(2.0) * 0.04, 0.0015);
}

TEST(MotionSamplerTest, OldModelsTakeTheSameNumbersAsDeviations) {
  const Pose2 straight{2.0, 0.0, 0.0};
  EXPECT_NEAR(Spread(Alphas(MotionKind::kOmni, 0, 0, 0.01, 0, 0), straight)[0], 0.04, 0.001);
  EXPECT_NEAR(Spread(Alphas(MotionKind::kDiff, 0, 0, 0.01, 0, 0), straight)[0], 0.04, 0.001);
}

TEST(MotionSamplerTest, TurningOnTheSpotErrsByTurning) {
  const Pose2 turn{0.0, 0.0, 1.5};
  EXPECT_NEAR(Spread(Alphas(MotionKind::kOmniCorrected, 0, 0, 0, 0.01, 0), turn)[2], 0.15, 0.004);
  EXPECT_NEAR(Spread(Alphas(MotionKind::kDiffCorrected, 0.01, 0, 0, 0, 0), turn)[2], 0.15, 0.004);
}

TEST(MotionSamplerTest, DrivingBackwardsIsAsCertainAsDrivingForwards) {
  const OdometryModelParams params = Alphas(MotionKind::kDiffCorrected, 0.2, 0.001, 0.01, 0.2, 0);
  const Eigen::Vector3d forwards = Spread(params, {1.0, 0.0, 0.0});
  const Eigen::Vector3d backwards = Spread(params, {-1.0, 0.0, 0.0});
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(backwards[axis] / forwards[axis], 1.0, 0.03);
}

TEST(MotionSamplerTest, NamesAreThoseOfAmcl) {
  EXPECT_EQ(MotionKindOf("diff"), MotionKind::kDiff);
  EXPECT_EQ(MotionKindOf("omni"), MotionKind::kOmni);
  EXPECT_EQ(MotionKindOf("diff-corrected"), MotionKind::kDiffCorrected);
  EXPECT_EQ(MotionKindOf("omni-corrected"), MotionKind::kOmniCorrected);
  EXPECT_ANY_THROW(MotionKindOf("tracked"));
}

}  // namespace
}  // namespace hires::localisation::odometry_model_test
