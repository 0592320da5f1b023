#include "hires/navigation/slow_before.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hires/base/rng.h"
#include "hires/navigation/car_follower.h"

namespace hires::navigation::slow_before_test {
namespace {

using Eigen::Vector2d;
using geometry::Twist2;

const geometry::Polygon kBody{{0.3, -0.3}, {0.3, 0.3}, {-0.3, 0.3}, {-0.3, -0.3}};
const SlowBeforeParams kParams;

TEST(SlowBeforeTest, WithNothingAheadItIsAsWanted) {
  const Twist2 wanted{0.3, 0.1, -0.2};
  for (const std::vector<Vector2d>& things :
       {std::vector<Vector2d>{}, {{-0.4, 0.0}}, {{3.0, 0.0}}, {{0.4, -0.6}}}) {
    const Twist2 slowed = SlowedBefore(wanted, things, kBody, kParams);
    EXPECT_EQ(slowed.vx, wanted.vx);
    EXPECT_EQ(slowed.vy, wanted.vy);
    EXPECT_EQ(slowed.wz, wanted.wz);
  }
}

TEST(SlowBeforeTest, TheSpeedIsThatFromWhichItStopsBeforeTheThing) {
  for (const double free : {0.02, 0.05, 0.08}) {
    const double thing = 0.3 + kParams.gap + free;
    const Twist2 slowed = SlowedBefore({0.3, 0.0, 0.0}, {{thing, 0.1}}, kBody, kParams);
    const double allowed = ApproachSpeed(free, kParams.deceleration, kParams.reaction_time);
    EXPECT_LE(slowed.vx, allowed + 1e-9) << free;
    EXPECT_GE(slowed.vx, ApproachSpeed(free - 2e-4, kParams.deceleration, kParams.reaction_time))
        << free;
  }
}

TEST(SlowBeforeTest, WhatIsNearerThanTheGapStopsOnlyWhatWouldBringItNearer) {
  const std::vector<Vector2d> ahead{{0.305, 0.0}};
  EXPECT_EQ(SlowedBefore({0.2, 0.0, 0.0}, ahead, kBody, kParams).vx, 0.0);
  EXPECT_EQ(SlowedBefore({-0.2, 0.0, 0.0}, ahead, kBody, kParams).vx, -0.2);
  EXPECT_EQ(SlowedBefore({0.0, 0.1, 0.0}, ahead, kBody, kParams).vy, 0.1) << "it slides along";
}

TEST(SlowBeforeTest, WhatCannotBrakeDoesNotDrive) {
  SlowBeforeParams params;
  params.angular_deceleration = 0.0;
  const std::vector<Vector2d> beside{{0.0, 0.9}};
  EXPECT_EQ(SlowedBefore({0.2, 0.0, 0.1}, beside, kBody, params).vx, 0.0);
  EXPECT_EQ(SlowedBefore({0.2, 0.0, 0.0}, beside, kBody, params).vx, 0.2)
      << "without a turn it can";
  params.deceleration = 0.0;
  EXPECT_EQ(SlowedBefore({0.2, 0.0, 0.0}, beside, kBody, params).vx, 0.0);
}

/// What is slower to stop turning than to stop driving slows down for it as well.
TEST(SlowBeforeTest, TurnsBrakeByTheirOwnLimit) {
  const std::vector<Vector2d> thing{{0.2, 0.34}};  // the corner sweeps it, turning left
  SlowBeforeParams quick, slow;
  quick.angular_deceleration = 2.0;
  slow.angular_deceleration = 0.1;
  const double first = SlowedBefore({0.0, 0.0, 0.5}, thing, kBody, quick).wz,
               second = SlowedBefore({0.0, 0.0, 0.5}, thing, kBody, slow).wz;
  EXPECT_GT(first, 0.0);
  EXPECT_LT(second, 0.8 * first);
}

TEST(SlowBeforeTest, ItComesToRestTheGapBeforeAThing) {
  for (const Twist2& wanted : {Twist2{0.3, 0.0, 0.0}, Twist2{0.2, 0.05, 0.0}}) {
    geometry::Pose2 X_MB;
    const Vector2d thing_M(0.8, 0.1);
    for (int cycle = 0; cycle < 400; ++cycle) {
      const Twist2 V = SlowedBefore(wanted, {X_MB.Inverse() * thing_M}, kBody, kParams);
      X_MB = X_MB * geometry::Pose2{V.vx * 0.05, V.vy * 0.05, V.wz * 0.05};
    }
    EXPECT_NEAR(thing_M.x() - X_MB.x - 0.3, kParams.gap, 2e-3);
  }
}

/// Of a laser that errs by a centimetre, walls lie now nearer and now farther.
TEST(SlowBeforeTest, AlongWallsThreeCentimetresAsideItDrivesOn) {
  base::Rng rng(9);
  geometry::Pose2 X_MB;
  double nearest = 1.0;
  for (int cycle = 0; cycle < 200; ++cycle) {
    std::vector<Vector2d> things_B;
    for (const double side : {-0.33, 0.33}) {
      for (double x = -1.0; x < 3.0; x += 0.02) {
        const Vector2d seen_M(x, side + rng.Normal(0.0, 0.01));
        things_B.push_back(X_MB.Inverse() * seen_M);
      }
    }
    const Twist2 wanted{0.3, 0.02 * rng.Normal(0.0, 1.0), 0.02 * rng.Normal(0.0, 1.0)};
    const Twist2 V = SlowedBefore(wanted, things_B, kBody, kParams);
    X_MB = X_MB * geometry::Pose2{V.vx * 0.05, V.vy * 0.05, V.wz * 0.05};
    for (const Vector2d& corner : geometry::Transformed(X_MB, kBody))
      nearest = std::min(nearest, 0.33 - std::abs(corner.y()));
  }
  EXPECT_GT(nearest, 0.0);
  EXPECT_GT(X_MB.x, 0.5) << "of 3 m in 10 s that were wanted";
}

TEST(SlowBeforeTest, ATurnThatWouldSweepAThingIsStopped) {
  // Beyond the middle of an edge lies room that a corner sweeps.
  const std::vector<Vector2d> thing{{0.35, 0.0}};
  const Twist2 slowed = SlowedBefore({0.0, 0.0, 1.0}, thing, kBody, kParams);
  EXPECT_LT(slowed.wz, 1.0);
  EXPECT_EQ(slowed.vx, 0.0);
  EXPECT_EQ(slowed.vy, 0.0);
}

/// Drives as it is told until nothing changes; the wheels follow the command at once.
TEST(SlowBeforeTest, WhateverIsWantedNothingIsTouchedNorDrivenFasterOrElsewhere) {
  base::Rng rng(7);
  constexpr double kDt = 0.05;
  int num_stopped = 0;
  for (int run = 0; run < 300; ++run) {
    const Twist2 wanted{rng.Uniform(-0.3, 0.3), rng.Uniform(-0.3, 0.3), rng.Uniform(-0.5, 0.5)};
    std::vector<Vector2d> things_M;
    while (things_M.size() < 5) {
      const Vector2d thing(rng.Uniform(-1.2, 1.2), rng.Uniform(-1.2, 1.2));
      if (thing.cwiseAbs().maxCoeff() > 0.32) things_M.push_back(thing);
    }
    geometry::Pose2 X_MB;
    Twist2 last;
    for (int cycle = 0; cycle < 100; ++cycle) {
      std::vector<Vector2d> things_B;
      for (const Vector2d& thing : things_M) things_B.push_back(X_MB.Inverse() * thing);
      last = SlowedBefore(wanted, things_B, kBody, kParams);
      const double share =
          std::hypot(last.vx, last.vy, last.wz) / std::hypot(wanted.vx, wanted.vy, wanted.wz);
      ASSERT_LE(share, 1.0 + 1e-12);
      ASSERT_NEAR(last.vx, share * wanted.vx, 1e-12);
      ASSERT_NEAR(last.vy, share * wanted.vy, 1e-12);
      ASSERT_NEAR(last.wz, share * wanted.wz, 1e-12);
      X_MB = X_MB * geometry::Pose2{last.vx * kDt, last.vy * kDt, last.wz * kDt};
      for (const Vector2d& thing : things_M)
        ASSERT_FALSE(geometry::Contains(kBody, X_MB.Inverse() * thing)) << "run " << run;
    }
    num_stopped += std::hypot(last.vx, last.vy, last.wz) < 0.02 ? 1 : 0;
  }
  EXPECT_GT(num_stopped, 50) << "else nothing stood in the way";
}

}  // namespace
}  // namespace hires::navigation::slow_before_test
