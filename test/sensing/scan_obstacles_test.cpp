#include "hires/sensing/scan_obstacles.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "support/scenes.h"

namespace hires::sensing::scan_obstacles_test {
namespace {

using geometry::Pose2;
using test_support::Room;
using test_support::TrayRobot;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::shared_ptr<const navigation::Costmap> RoomMap() {
  return std::make_shared<const navigation::Costmap>(world::SliceWorld(Room(), 0.1, 0.9), 0.25,
                                                     navigation::CostmapParams{});
}

/// A single beam, straight ahead.
robot::ScanReading Beam(double range) { return {0.0, 0.01, 0.08, {static_cast<float>(range)}}; }

class ScanObstaclesTest : public ::testing::Test {
 protected:
  ScanObstacles obstacles_{RoomMap(), TrayRobot().profile.footprint, {}};
  const Pose2 X_MB_{3.0, 2.0, 0.0};  // the east wall stands at x = 6
};

TEST_F(ScanObstaclesTest, APointInFreeSpaceBecomesASquareAroundIt) {
  const auto found = obstacles_.Find(Beam(1.02), X_MB_, {});
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_TRUE(geometry::Contains(found[0], {4.02, 2.0}));
  EXPECT_NEAR(found[0][1].x() - found[0][0].x(), 0.05, 1e-12);
}

TEST_F(ScanObstaclesTest, AWallOfTheMapIsNoObstacle) {
  EXPECT_THAT(obstacles_.Find(Beam(2.4), {3.6, 2.0, 0.0}, {}), IsEmpty());
  EXPECT_THAT(obstacles_.Find(Beam(2.3), {3.6, 2.0, 0.0}, {}), IsEmpty());
}

TEST_F(ScanObstaclesTest, TheRobotItselfIsNoObstacle) {
  EXPECT_THAT(obstacles_.Find(Beam(0.2), X_MB_, {}), IsEmpty());
}

TEST_F(ScanObstaclesTest, WhatIsFarOrNoMeasurementIsLeftOut) {
  for (const double range : {2.6, 0.05, std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THAT(obstacles_.Find(Beam(range), X_MB_, {}), IsEmpty()) << range;
  }
}

TEST_F(ScanObstaclesTest, ManyPointsOfOneCellAreOneSquare) {
  EXPECT_THAT(obstacles_.Find({0.0, 0.0001, 0.08, {1.02f, 1.02f, 1.03f}}, X_MB_, {}), SizeIs(1));
}

}  // namespace
}  // namespace hires::sensing::scan_obstacles_test
