#include "hires/geometry/pose.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"

namespace hires::geometry::pose_test {
namespace {

constexpr double kExact = 1e-12;  // a few roundings of numbers of order 10

Pose2 RandomPose2(base::Rng* rng) {
  const double x = rng->Uniform(-5.0, 5.0), y = rng->Uniform(-5.0, 5.0);
  return {x, y, rng->Uniform(-kPi, kPi)};
}

Eigen::Vector3d RandomVector(base::Rng* rng) {
  const double x = rng->Uniform(-5.0, 5.0), y = rng->Uniform(-5.0, 5.0);
  return {x, y, rng->Uniform(-5.0, 5.0)};
}

Pose3 RandomPose3(base::Rng* rng) {
  const Eigen::Vector3d translation = RandomVector(rng);
  const double roll = rng->Uniform(-kPi, kPi), pitch = rng->Uniform(-1.5, 1.5);
  return {translation, RotationFromRpy(roll, pitch, rng->Uniform(-kPi, kPi))};
}

/// q and -q are one rotation.
double AngleBetween(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return a.angularDistance(b);
}

void ExpectNear(const Pose2& a, const Pose2& b) {
  EXPECT_NEAR(a.x, b.x, kExact);
  EXPECT_NEAR(a.y, b.y, kExact);
  EXPECT_NEAR(WrapToPi(a.yaw - b.yaw), 0.0, kExact);
}

void ExpectNear(const Pose3& a, const Pose3& b) {
  EXPECT_LT((a.translation - b.translation).norm(), kExact);
  EXPECT_LT(AngleBetween(a.rotation, b.rotation), 1e-7);  // acos near 1 halves the digits
}

TEST(Pose2Test, IsTheIdentityFromBirth) { ExpectNear(Pose2{}, {0.0, 0.0, 0.0}); }

TEST(Pose2Test, ChainsFromOuterToInnerFrame) {
  const Pose2 X_MB{1.0, 2.0, kPi / 2}, X_BT{3.0, 0.5, kPi};
  ExpectNear(X_MB * X_BT, {0.5, 5.0, -kPi / 2});
  EXPECT_TRUE((X_MB * Eigen::Vector2d(3.0, 0.5)).isApprox(Eigen::Vector2d(0.5, 5.0), kExact));
}

TEST(Pose2Test, ItsPositionIsItsOrigin) {
  EXPECT_EQ((Pose2{1.0, 2.0, 3.0}.position()), Eigen::Vector2d(1.0, 2.0));
}

TEST(Pose2Test, InverseOfAKnownPose) {
  ExpectNear((Pose2{1.0, 2.0, kPi / 2}.Inverse()), {-2.0, 1.0, -kPi / 2});
}

TEST(Pose2Test, InverseTakesBackFromBothSides) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    base::Rng rng = base::Rng(1).Fork(seed);
    const Pose2 X_AB = RandomPose2(&rng);
    ExpectNear(X_AB * X_AB.Inverse(), {});
    ExpectNear(X_AB.Inverse() * X_AB, {});
  }
}

TEST(Pose2Test, ChainingIsAssociativeAndWrapsItsAngle) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    base::Rng rng = base::Rng(2).Fork(seed);
    const Pose2 a = RandomPose2(&rng), b = RandomPose2(&rng), c = RandomPose2(&rng);
    ExpectNear((a * b) * c, a * (b * c));
    EXPECT_LE(std::abs((a * b).yaw), kPi);
    EXPECT_TRUE(((a * b) * c.position()).isApprox(a * (b * c.position()), kExact));
  }
}

TEST(Pose3Test, IsTheIdentityFromBirth) {
  EXPECT_EQ(Pose3{} * Eigen::Vector3d(1.0, 2.0, 3.0), Eigen::Vector3d(1.0, 2.0, 3.0));
}

TEST(Pose3Test, ChainsFromOuterToInnerFrame) {
  const Pose3 X_AB{{1.0, 2.0, 3.0}, RotationFromRpy(0.0, 0.0, kPi / 2)};
  EXPECT_TRUE(
      (X_AB * Eigen::Vector3d(1.0, 0.0, 0.5)).isApprox(Eigen::Vector3d(1.0, 3.0, 3.5), kExact));
}

TEST(Pose3Test, InverseTakesBackFromBothSides) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    base::Rng rng = base::Rng(3).Fork(seed);
    const Pose3 X_AB = RandomPose3(&rng);
    ExpectNear(X_AB * X_AB.Inverse(), {});
    ExpectNear(X_AB.Inverse() * X_AB, {});
  }
}

TEST(Pose3Test, AgreesWithHomogeneousMatrices) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    base::Rng rng = base::Rng(4).Fork(seed);
    const Pose3 X_AB = RandomPose3(&rng), X_BC = RandomPose3(&rng);
    const Eigen::Vector3d p_C = RandomVector(&rng);
    const auto matrix = [](const Pose3& pose) {
      return Eigen::Isometry3d(Eigen::Translation3d(pose.translation) * pose.rotation);
    };
    EXPECT_TRUE(((X_AB * X_BC) * p_C).isApprox(matrix(X_AB) * matrix(X_BC) * p_C, kExact));
  }
}

TEST(Pose3Test, AThousandStepsKeepTheQuaternionOfUnitLength) {
  base::Rng rng(5);
  Pose3 pose;
  for (int i = 0; i < 1000; ++i) pose = pose * RandomPose3(&rng);
  EXPECT_NEAR(pose.rotation.norm(), 1.0, 1e-15);
}

TEST(Pose3Test, OnlyFiniteNumbersAreFinite) {
  EXPECT_TRUE(Pose3{}.IsFinite());
  Pose3 pose;
  pose.translation.z() = INFINITY;
  EXPECT_FALSE(pose.IsFinite());
  pose = {};
  pose.rotation.x() = NAN;
  EXPECT_FALSE(pose.IsFinite());
}

TEST(TwistTest, RestsFromBirth) {
  EXPECT_EQ(Twist2{}.vx, 0.0);
  EXPECT_EQ(Twist2{}.vy, 0.0);
  EXPECT_EQ(Twist2{}.wz, 0.0);
  EXPECT_TRUE(Twist3{}.linear.isZero(0.0));
  EXPECT_TRUE(Twist3{}.angular.isZero(0.0));
}

TEST(RotationFromRpyTest, TurnsAboutFixedAxesRollFirst) {
  const auto turned = [](double r, double p, double y, const Eigen::Vector3d& v) {
    return Eigen::Vector3d(RotationFromRpy(r, p, y) * v);
  };
  const Eigen::Vector3d x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  EXPECT_TRUE(turned(kPi / 2, 0, 0, y).isApprox(z, kExact));
  EXPECT_TRUE(turned(0, kPi / 2, 0, z).isApprox(x, kExact));
  EXPECT_TRUE(turned(0, 0, kPi / 2, x).isApprox(y, kExact));
  // Roll takes y to z, pitch takes z to x, yaw takes x to y.
  EXPECT_TRUE(turned(kPi / 2, kPi / 2, kPi / 2, y).isApprox(y, kExact));
  EXPECT_TRUE(turned(kPi / 2, kPi / 2, 0, y).isApprox(x, kExact));
}

TEST(YawOfTest, IsTheYawThatWentIn) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    base::Rng rng = base::Rng(6).Fork(seed);
    const double roll = rng.Uniform(-kPi, kPi), pitch = rng.Uniform(-1.5, 1.5);
    const double yaw = rng.Uniform(-kPi, kPi);
    EXPECT_NEAR(WrapToPi(YawOf(RotationFromRpy(roll, pitch, yaw)) - yaw), 0.0, 1e-12);
  }
}

TEST(LiftTest, FlattenTakesItBack) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    base::Rng rng = base::Rng(7).Fork(seed);
    const Pose2 pose = RandomPose2(&rng);
    const Pose3 lifted = Lift(pose, 0.7);
    EXPECT_EQ(lifted.translation, Eigen::Vector3d(pose.x, pose.y, 0.7));
    EXPECT_NEAR(TiltOf(lifted.rotation), 0.0, kExact);
    ExpectNear(Flatten(lifted), pose);
  }
}

TEST(LiftTest, KeepsChains) {
  base::Rng rng(8);
  const Pose2 a = RandomPose2(&rng), b = RandomPose2(&rng);
  ExpectNear(Lift(a) * Lift(b), Lift(a * b));
}

TEST(FlattenTest, DropsHeightRollAndPitch) {
  ExpectNear(Flatten({{1.0, 2.0, 3.0}, RotationFromRpy(0.2, -0.3, 0.4)}), {1.0, 2.0, 0.4});
}

TEST(TiltOfTest, KnownTilts) {
  EXPECT_EQ(TiltOf(Eigen::Quaterniond::Identity()), 0.0);
  EXPECT_NEAR(TiltOf(RotationFromRpy(0.0, 0.5, 1.0)), 0.5, kExact);
  EXPECT_NEAR(TiltOf(RotationFromRpy(-kPi / 2, 0.0, 0.0)), kPi / 2, kExact);
  EXPECT_NEAR(TiltOf(RotationFromRpy(kPi, 0.0, 0.0)), kPi, kExact);
}

TEST(TiltOfTest, SmallTiltsKeepTheirDigits) {
  EXPECT_NEAR(TiltOf(RotationFromRpy(1e-9, 0.0, 0.0)) / 1e-9, 1.0, 1e-9);
}

TEST(TiltOfTest, SpinningTheBodyOrTheWorldChangesNothing) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    base::Rng rng = base::Rng(9).Fork(seed);
    const Eigen::Quaterniond R_WB = RandomPose3(&rng).rotation;
    const Eigen::Quaterniond spin = RotationFromRpy(0.0, 0.0, rng.Uniform(-kPi, kPi));
    EXPECT_NEAR(TiltOf(R_WB * spin), TiltOf(R_WB), kExact);
    EXPECT_NEAR(TiltOf(spin * R_WB), TiltOf(R_WB), kExact);
  }
}

}  // namespace
}  // namespace hires::geometry::pose_test
