#include "hires/navigation/reeds_shepp.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"

namespace hires::navigation::reeds_shepp_test {
namespace {

using geometry::kPi;
using geometry::Pose2;

constexpr double kRadius = 0.8;

double Between(const Pose2& a, const Pose2& b) { return ReedsSheppWays(kRadius).Distance(a, b); }

TEST(ReedsSheppTest, KnownWaysHaveTheirLengths) {
  const Pose2 here{1.0, 2.0, 0.5};
  const auto from_here = [&](double x, double y, double yaw) {
    return Between(here, here * Pose2{x, y, yaw});
  };
  EXPECT_NEAR(from_here(0.0, 0.0, 0.0), 0.0, 1e-9);
  EXPECT_NEAR(from_here(3.0, 0.0, 0.0), 3.0, 1e-9);
  EXPECT_NEAR(from_here(-3.0, 0.0, 0.0), 3.0, 1e-9);                           // backward
  EXPECT_NEAR(from_here(kRadius, kRadius, kPi / 2), kRadius * kPi / 2, 1e-9);  // a quarter circle
  EXPECT_NEAR(from_here(-kRadius, -kRadius, kPi / 2), kRadius * kPi / 2, 1e-9);
  EXPECT_NEAR(from_here(0.0, 2.0 * kRadius, kPi), kRadius * kPi, 1e-9);  // half a circle
  // Turning about in place: three arcs of 60 degrees, forward, backward, forward.
  EXPECT_NEAR(from_here(0.0, 0.0, kPi), kRadius * kPi, 1e-9);
}

TEST(ReedsSheppTest, ParkingBesideIsFourArcs) {
  // Forward by an arc that turns by a, backward turning on by u and back by u, forward turning back
  // by a. It ends where it began, but aside, if sin(a + u) = 2 sin(a).
  for (const double sine : {0.02, 0.1, 0.2, 0.3}) {
    const double a_and_u = std::asin(2.0 * sine), cosine = std::sqrt(1.0 - sine * sine);
    const double aside = kRadius * (4.0 * cosine - 2.0 * std::cos(a_and_u) - 2.0);
    EXPECT_NEAR(Between({}, {0.0, aside, 0.0}), 2.0 * kRadius * a_and_u, 1e-9) << aside;
    EXPECT_NEAR(Between({}, {0.0, -aside, 0.0}), 2.0 * kRadius * a_and_u, 1e-9) << aside;
  }
}

TEST(ReedsSheppTest, EndsAtTheGoalOnArcsThatTheCarCanDrive) {
  const ReedsSheppWays ways(kRadius);
  for (int seed = 0; seed < 2000; ++seed) {
    base::Rng rng(seed);
    const auto pose = [&] {
      const double x = rng.Uniform(-3.0, 3.0), y = rng.Uniform(-3.0, 3.0);
      return Pose2{x, y, rng.Uniform(-kPi, kPi)};
    };
    const Pose2 from = pose(), to = pose();
    const auto arcs = ways.Shortest(from, to);
    std::vector<CarPose> poses;
    AppendPoses(from, arcs, 0.1, &poses);
    ASSERT_FALSE(poses.empty());
    EXPECT_NEAR((poses.back().X_MB.position() - to.position()).norm(), 0.0, 1e-6) << seed;
    EXPECT_NEAR(geometry::WrapToPi(poses.back().X_MB.yaw - to.yaw), 0.0, 1e-6) << seed;
    EXPECT_NEAR(LengthOf(arcs), ways.Distance(from, to), 1e-9) << seed;
    EXPECT_GE(LengthOf(arcs) + 1e-9, (to.position() - from.position()).norm()) << seed;
    for (const CarArc& arc : arcs) EXPECT_LE(std::abs(arc.curvature), 1.0 / kRadius + 1e-12);
    // The same way back is as long.
    EXPECT_NEAR(ways.Distance(to, from), LengthOf(arcs), 1e-6) << seed;
  }
}

TEST(ReedsSheppTest, PosesKeepTheirDistanceAndTheirDirection) {
  std::vector<CarPose> poses;
  AppendPoses({1.0, 0.0, 0.0}, {{0.25, 0.0}, {-0.4, 1.0}}, 0.1, &poses);
  ASSERT_EQ(poses.size(), 7u);
  EXPECT_NEAR(poses[2].X_MB.x, 1.25, 1e-12);
  EXPECT_FALSE(poses[2].is_backward);
  EXPECT_TRUE(poses[3].is_backward);
  EXPECT_NEAR(poses.back().X_MB.yaw, -0.4, 1e-12);
  EXPECT_NEAR(poses.back().X_MB.x, 1.25 - std::sin(0.4), 1e-12);
  EXPECT_NEAR(poses.back().X_MB.y, 1.0 - std::cos(0.4), 1e-12);
}

TEST(ReedsSheppTest, ACarWithoutARadiusIsRefused) {
  EXPECT_THROW(ReedsSheppWays(0.0), std::logic_error);
}

}  // namespace
}  // namespace hires::navigation::reeds_shepp_test
