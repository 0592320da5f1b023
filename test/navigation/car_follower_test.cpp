#include "hires/navigation/car_follower.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "navigation/closed_loop.h"

namespace hires::navigation::car_follower_test {
namespace {

using geometry::kPi;
using geometry::Pose2;
using geometry::Twist2;
using test_support::Rectangle;

constexpr double kRadius = 0.75;
const geometry::Polygon kCar = Rectangle(-0.12, -0.2, 0.52, 0.2);
const robot::MotionSet kFast{0.8, 1.2, 1.0, 2.0};
const robot::MotionSet kSlow{0.3, 0.6, 0.5, 1.0};

struct Drive {
  DwaStatus status{DwaStatus::kDriving};
  Pose2 X_MB;
  double duration{0.0};      // [s]
  double farthest{0.0};      // [m] off the path
  double fastest{0.0};       // [m/s]
  double fastest_turn{0.0};  // [rad/s]
};

double DistanceTo(const std::vector<CarPose>& path, const Pose2& X_MB) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const CarPose& pose : path) {
    nearest = std::min(nearest, (pose.X_MB.position() - X_MB.position()).norm());
  }
  return nearest;
}

/// Closed loop with a car that does exactly what it is told. Every command is within the limits.
Drive Follow(std::vector<CarPose> path, const Pose2& X_MStart, const robot::MotionSet& limits,
             const Costmap* costmap = nullptr, double longest = 120.0) {
  const CarFollowerParams params;
  CarFollower follower(params, kCar, kRadius);
  follower.SetMotionSet(limits);
  follower.SetPath(path);
  Drive drive;
  drive.X_MB = X_MStart;
  Twist2 V_B;
  for (; drive.duration < longest; drive.duration += params.control_period) {
    const DwaResult result = follower.Update(costmap, drive.X_MB, V_B);
    drive.status = result.status;
    if (result.status != DwaStatus::kDriving) break;
    const Twist2& wanted = result.velocity;
    EXPECT_EQ(wanted.vy, 0.0);
    EXPECT_LE(std::abs(wanted.wz), std::abs(wanted.vx) / kRadius + 1e-9);
    EXPECT_LE(std::abs(wanted.vx - V_B.vx),
              limits.max_linear_acceleration * params.control_period + 1e-9);
    EXPECT_LE(std::abs(wanted.vx), limits.max_linear_velocity + 1e-9);
    EXPECT_LE(std::abs(wanted.wz), limits.max_angular_velocity + 1e-9);
    V_B = wanted;
    drive.fastest = std::max(drive.fastest, std::abs(V_B.vx));
    drive.fastest_turn = std::max(drive.fastest_turn, std::abs(V_B.wz));
    drive.X_MB = PoseAfter(drive.X_MB, V_B, params.control_period);
    drive.farthest = std::max(drive.farthest, DistanceTo(path, drive.X_MB));
  }
  return drive;
}

std::vector<CarPose> WayBetween(const Pose2& from, const Pose2& to) {
  std::vector<CarPose> path{{from}};
  AppendPoses(from, ReedsSheppWays(1.1 * kRadius).Shortest(from, to), 0.05, &path);
  return path;
}

TEST(CarFollowerTest, ArrivesOnRandomWays) {
  for (int seed = 1; seed <= 40; ++seed) {
    base::Rng rng(seed);
    const Pose2 to{rng.Uniform(-3.0, 3.0), rng.Uniform(-3.0, 3.0), rng.Uniform(-kPi, kPi)};
    for (const robot::MotionSet& limits : {kFast, kSlow}) {
      const Drive drive = Follow(WayBetween({}, to), {}, limits);
      EXPECT_EQ(drive.status, DwaStatus::kGoalReached) << seed;
      EXPECT_LE((drive.X_MB.position() - to.position()).norm(), 0.03) << seed;
      EXPECT_LE(std::abs(geometry::WrapToPi(drive.X_MB.yaw - to.yaw)), 0.05) << seed;
      EXPECT_LE(drive.farthest, 0.05) << seed;
    }
  }
}

TEST(CarFollowerTest, DrivesAsFastAsItsMotionSetAndItsWayAllow) {
  const Drive straight = Follow(WayBetween({}, {4.0, 0.0, 0.0}), {}, kFast);
  EXPECT_NEAR(straight.fastest, kFast.max_linear_velocity, 1e-9);
  const Drive slow = Follow(WayBetween({}, {4.0, 0.0, 0.0}), {}, kSlow);
  EXPECT_NEAR(slow.fastest, kSlow.max_linear_velocity, 1e-9);
  EXPECT_GT(slow.duration, straight.duration + 5.0);
  robot::MotionSet gentle = kFast;
  gentle.max_angular_velocity = 0.2;
  const Drive turning = Follow(WayBetween({}, {1.65, 1.65, kPi / 2}), {}, gentle);
  EXPECT_EQ(turning.status, DwaStatus::kGoalReached);
  EXPECT_LE(turning.fastest_turn, 0.2 + 1e-9);
}

TEST(CarFollowerTest, ComesBackToItsWayForwardAndBackward) {
  for (const double ahead : {4.0, -4.0}) {
    const Pose2 to{ahead, 0.0, 0.0};
    const Drive drive = Follow(WayBetween({}, to), {0.0, 0.15, 0.2}, kSlow);
    EXPECT_EQ(drive.status, DwaStatus::kGoalReached) << ahead;
    EXPECT_NEAR(drive.X_MB.y, 0.0, 0.01) << ahead;
    EXPECT_NEAR(drive.X_MB.yaw, 0.0, 0.02) << ahead;
  }
}

TEST(CarFollowerTest, StopsBeforeWhatCameIntoItsWay) {
  world::OccupancyGrid grid = test_support::FreeGrid(120, 60);
  test_support::AddRectangle(&grid, 4.0, 1.0, 4.2, 2.0);
  const Costmap costmap(grid, 0.12, {});
  const Pose2 from{1.0, 1.5, 0.0};
  const Drive drive = Follow(WayBetween(from, {5.0, 1.5, 0.0}), from, kFast, &costmap);
  EXPECT_EQ(drive.status, DwaStatus::kNoValidTrajectory);
  EXPECT_LT(drive.X_MB.x + 0.52, 4.0);
  EXPECT_GT(drive.X_MB.x + 0.52, 3.0);
}

TEST(CarFollowerTest, AWayThatIsFarOffIsLost) {
  const Drive drive = Follow(WayBetween({}, {4.0, 0.0, 0.0}), {0.0, 0.6, 0.0}, kSlow);
  EXPECT_EQ(drive.status, DwaStatus::kNoValidTrajectory);
  EXPECT_EQ(drive.duration, 0.0);
}

TEST(CarFollowerTest, AWayOfOnePoseIsOver) {
  EXPECT_EQ(Follow({{{1.0, 2.0, 0.3}}}, {1.0, 2.0, 0.3}, kSlow).status, DwaStatus::kGoalReached);
}

TEST(CarFollowerTest, RefusesWhatIsNoCar) {
  EXPECT_THROW(CarFollower({}, kCar, 0.0), std::logic_error);
  EXPECT_THROW(CarFollower({}, kCar, 1.0).SetPath({}), std::logic_error);
}

}  // namespace
}  // namespace hires::navigation::car_follower_test
