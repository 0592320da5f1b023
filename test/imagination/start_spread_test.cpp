#include "hires/imagination/start_spread.h"

#include <gmock/gmock.h>

#include <cmath>
#include <memory>
#include <optional>

#include "hires/base/error.h"

namespace hires::imagination::start_spread_test {
namespace {

using geometry::Pose2;
using ::testing::HasSubstr;

Uncertainty Shipped() { return LoadUncertainty(HIRES_SOURCE_DIR "/config/uncertainty.yaml"); }

BelievedPose Believed(double yaw, double xx, double yy, double aa) {
  BelievedPose believed{{3.0, 4.0, yaw}, Eigen::Matrix3d::Zero()};
  believed.covariance.diagonal() << xx, yy, aa;
  return believed;
}

TEST(StartSpreadTest, IsTheRootOfTheVariances) {
  const StartSpread spread = SpreadOf(Believed(0.0, 0.04, 0.01, 0.0025), "amcl_pose");
  EXPECT_DOUBLE_EQ(spread.x, 0.2);
  EXPECT_DOUBLE_EQ(spread.y, 0.1);
  EXPECT_DOUBLE_EQ(spread.yaw, 0.05);
}

TEST(StartSpreadTest, IsAlongTheRobotsAxes) {
  const StartSpread spread = SpreadOf(Believed(M_PI / 2, 0.04, 0.01, 0.0), "amcl_pose");
  EXPECT_NEAR(spread.x, 0.1, 1e-12);
  EXPECT_NEAR(spread.y, 0.2, 1e-12);
}

TEST(StartSpreadTest, WhatGoesTogetherCountsWhenTurned) {
  BelievedPose believed = Believed(M_PI / 4, 0.02, 0.02, 0.0);
  believed.covariance(0, 1) = believed.covariance(1, 0) = 0.01;
  const StartSpread spread = SpreadOf(believed, "amcl_pose");
  EXPECT_NEAR(spread.x, std::sqrt(0.03), 1e-12);
  EXPECT_NEAR(spread.y, std::sqrt(0.01), 1e-12);
}

TEST(StartSpreadTest, ALostRobotHasNone) {
  for (const BelievedPose& believed :
       {Believed(0.0, 1.5, 0.0, 0.0), Believed(0.0, 0.0, 1.5, 0.0), Believed(0.0, -0.1, 0.0, 0.0),
        Believed(0.0, 0.0, 0.0, NAN), Believed(0.0, INFINITY, 0.0, 0.0)}) {
    EXPECT_THROW(SpreadOf(believed, "amcl_pose"), base::ConfigError);
  }
  try {
    SpreadOf(Believed(0.0, 2.0, 0.0, 0.0), "amcl_pose");
    FAIL();
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("amcl_pose: variance of x is 2"));
  }
}

TEST(StartSpreadTest, BeginsHereAsLongAsAmclIsSilent) {
  const BelievedPose believed = Believed(3.1, 0.0, 0.0, 0.0);
  EXPECT_TRUE(BeginsHere({3.15, 4.15, -2.8}, believed));
  EXPECT_FALSE(BeginsHere({3.3, 4.0, 3.1}, believed));
  EXPECT_FALSE(BeginsHere({3.0, 4.0, 2.4}, believed));
}

TEST(StartSpreadTest, ReplacesStartPosesAndNothingElse) {
  const Uncertainty before = Shipped();
  const Uncertainty after = WithStartSpread(before, {0.08, 0.06, 0.04, {}});
  for (const auto& [name, distribution] : before.quantities) {
    const Distribution& now = after.quantities.at(name);
    const bool is_start = name.rfind("start_", 0) == 0 || name.rfind("docked_", 0) == 0;
    EXPECT_EQ(now.kind, is_start ? Distribution::Kind::kNormal : distribution.kind) << name;
    if (is_start) continue;
    EXPECT_EQ(now.first, distribution.first) << name;
    EXPECT_EQ(now.second, distribution.second) << name;
  }
  EXPECT_EQ(after.quantities.size(), before.quantities.size());
  EXPECT_EQ(after.quantities.at("start_x").second, 0.08);
  EXPECT_EQ(after.quantities.at("docked_y").second, 0.06);
  EXPECT_EQ(after.quantities.at("start_yaw").second, 0.04);
  EXPECT_NE(after.hash, before.hash);
}

/// Workers read the text, and refuse it where its hash is another one.
TEST(StartSpreadTest, ItsTextIsTheSameUncertainty) {
  for (const double sd : {0.0, 0.1, 1.0 / 3.0, 0.07071067811865477, 0.5}) {
    const Uncertainty after = WithStartSpread(Shipped(), {sd, sd / 2, sd, {}});
    EXPECT_EQ(UncertaintyFromText(after.yaml, "text").hash, after.hash) << sd;
  }
}

TEST(StartSpreadTest, DrawsHaveTheSpread) {
  const Uncertainty after = WithStartSpread(Shipped(), {0.05, 0.02, 0.01, {}});
  const base::Rng rng(3);
  double sum = 0.0;
  constexpr int kDraws = 2000;
  for (int i = 0; i < kDraws; ++i) {
    const double x = SampleVariation(after, rng.Fork(i)).start_offset.x;
    EXPECT_LE(std::abs(x), 3 * 0.05);
    sum += x * x;
  }
  EXPECT_NEAR(std::sqrt(sum / kDraws), 0.05, 0.003);
}

/// Of a robot that knows better how far it is from the wall than where along it, seen askew, and
/// whose heading goes with that.
BelievedPose Askew() {
  BelievedPose believed = Believed(0.0, 0.002, 0.002, 0.001);
  believed.covariance(0, 1) = believed.covariance(1, 0) = 0.0016;
  believed.covariance(1, 2) = believed.covariance(2, 1) = -0.0007;
  return believed;
}

TEST(StartSpreadTest, WhatGoesTogetherIsDrawnTogether) {
  const StartSpread spread = SpreadOf(Askew(), "amcl_pose");
  EXPECT_NEAR(spread.correlation.x_y, 0.8, 1e-12);
  EXPECT_NEAR(spread.correlation.x_yaw, 0.0, 1e-12);
  EXPECT_NEAR(spread.correlation.y_yaw, -0.0007 / std::sqrt(0.002 * 0.001), 1e-12);
  const Uncertainty after = WithStartSpread(Shipped(), spread);
  const Uncertainty read = UncertaintyFromText(after.yaml, "text");
  EXPECT_EQ(read.hash, after.hash);
  EXPECT_NE(WithStartSpread(Shipped(), {spread.x, spread.y, spread.yaw, {}}).hash, after.hash);
  constexpr int kDraws = 4000;
  for (const Arrival arrival : {Arrival::kDriven, Arrival::kDocked}) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (int i = 0; i < kDraws; ++i) {
      const Pose2 off = SampleVariation(read, base::Rng(3).Fork(i), arrival).start_offset;
      const Eigen::Vector3d v(off.x, off.y, off.yaw);
      sum += v * v.transpose() / kDraws;
    }
    EXPECT_TRUE(sum.isApprox(Askew().covariance, 0.06)) << sum;
  }
}

TEST(StartSpreadTest, WhereNothingGoesTogetherDrawsAreAsTheyWere) {
  const Uncertainty after =
      WithStartSpread(Shipped(), SpreadOf(Believed(0.0, 0.04, 0.01, 0.0025), "amcl_pose"));
  EXPECT_FALSE(after.start_correlation);
}

TEST(StartSpreadTest, CorrelationsThatAreNoneAreRefused) {
  EXPECT_THROW(UncertaintyFromText("start_correlation: {x_y: 0.9, x_yaw: 0.9, y_yaw: -0.9}", "t"),
               base::ConfigError);
  EXPECT_THROW(UncertaintyFromText("start_correlation: {x_y: 1.1, x_yaw: 0, y_yaw: 0}", "t"),
               base::ConfigError);
}

TEST(StartSpreadTest, OnlyWhatBeginsHereAndIsSaidToBeUncertainBeginsSo) {
  const auto shipped = std::make_shared<const Uncertainty>(Shipped());
  const auto from = [&](const Pose2& X_MStart, const std::optional<BelievedPose>& believed) {
    return UncertaintyFrom(shipped, X_MStart, believed, "amcl_pose");
  };
  const BelievedPose believed = Askew();
  EXPECT_EQ(from(believed.X_MB, {}), shipped);
  EXPECT_EQ(from({0.0, 0.0, 0.0}, believed), shipped);
  EXPECT_EQ(from(believed.X_MB, Believed(0.0, 0.0, 0.0, 0.0)), shipped) << "a simulated robot's";
  EXPECT_EQ(from(believed.X_MB, believed)->hash,
            WithStartSpread(*shipped, SpreadOf(believed, "amcl_pose")).hash);
}

TEST(StartSpreadTest, WhereNothingIsUncertainNothingIs) {
  EXPECT_EQ(WithStartSpread(NoUncertainty(), {0.1, 0.1, 0.1, {}}).hash, NoUncertainty().hash);
  const Uncertainty mass = ParseUncertainty(
      "object_mass: {distribution: fixed, value: 1, unit: factor, source: x}", "t");
  EXPECT_EQ(WithStartSpread(mass, {0.1, 0.1, 0.1, {}}).hash, mass.hash);
}

}  // namespace
}  // namespace hires::imagination::start_spread_test
