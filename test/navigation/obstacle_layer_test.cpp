#include "hires/navigation/obstacle_layer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"

namespace hires::navigation::obstacle_layer_test {
namespace {

using Eigen::Vector2d;
using geometry::Pose2;
using State = ObstacleLayer::State;

constexpr float kNothing = std::numeric_limits<float>::infinity();
const geometry::Polygon kFootprint{{-0.3, -0.3}, {0.3, -0.3}, {0.3, 0.3}, {-0.3, 0.3}};

/// One beam straight ahead.
robot::ScanReading Ahead(float range) {
  robot::ScanReading scan;
  scan.angle_increment = 0.01;
  scan.range_min = 0.05;
  scan.range_max = 10.0;
  scan.ranges = {range};
  return scan;
}

class ObstacleLayerTest : public testing::Test {
 protected:
  void Insert(double time, float range, const Pose2& X_OB = {}) {
    layer_.Insert(time, Ahead(range), X_OB, {}, kFootprint);
  }
  State At(double x, double time = 0.0) const { return layer_.At({x, 0.01}, time); }

  ObstacleLayer layer_{{2.5, 3.0, 10.0}, 0.05};
};

TEST_F(ObstacleLayerTest, ABeamClearsItsWayAndItsEchoMarks) {
  Insert(0.0, 1.01f, {0.0, 0.01, 0.0});
  EXPECT_EQ(At(0.5), State::kFree);
  EXPECT_EQ(At(0.98), State::kFree);
  EXPECT_EQ(At(1.02), State::kObstacle);
  EXPECT_EQ(At(1.08), State::kUnseen) << "behind it";
  EXPECT_EQ(layer_.At({0.5, 0.2}, 0.0), State::kUnseen) << "beside it";
}

TEST_F(ObstacleLayerTest, WhatIsForgottenIsUnseen) {
  Insert(0.0, 1.01f, {0.0, 0.01, 0.0});
  layer_.Forget();
  EXPECT_EQ(At(0.5), State::kUnseen);
  EXPECT_THAT(layer_.Marks({}, 0.0), testing::IsEmpty());
}

TEST_F(ObstacleLayerTest, WhatMeetsNothingClearsAndMarksNothing) {
  Insert(0.0, kNothing);
  EXPECT_EQ(At(2.9), State::kFree);
  EXPECT_EQ(At(3.1), State::kUnseen) << "beyond raytrace_range";
  EXPECT_THAT(layer_.Marks({}, 0.0), testing::IsEmpty());
}

TEST_F(ObstacleLayerTest, AnEchoBeyondItsRangeClearsAlone) {
  Insert(0.0, 2.7f);
  EXPECT_EQ(At(2.6), State::kFree);
  EXPECT_EQ(At(2.71), State::kUnseen);
}

TEST_F(ObstacleLayerTest, WhatIsNoMeasurementDoesNothing) {
  for (const float range : {std::nanf(""), 0.0f, -1.0f, 0.01f, -kNothing}) Insert(0.0, range);
  EXPECT_EQ(At(0.02), State::kUnseen);
  EXPECT_THAT(layer_.Marks({}, 0.0), testing::IsEmpty());
}

TEST_F(ObstacleLayerTest, TheRobotsOwnPartsMarkNothing) {
  Insert(0.0, 0.25f);
  EXPECT_THAT(layer_.Marks({}, 0.0), testing::IsEmpty());
}

TEST_F(ObstacleLayerTest, WhatIsGoneIsClearedAndWhatCameIsMarked) {
  Insert(0.0, 1.01f);
  Insert(1.0, 2.01f);
  EXPECT_EQ(At(1.02, 1.0), State::kFree);
  EXPECT_EQ(At(2.02, 1.0), State::kObstacle);
  Insert(2.0, 1.01f);
  EXPECT_EQ(At(1.02, 2.0), State::kObstacle);
  EXPECT_EQ(At(2.02, 2.0), State::kObstacle) << "hidden now, but it was there";
}

TEST_F(ObstacleLayerTest, WhatWasNotSeenForLongIsForgotten) {
  Insert(5.0, 1.01f);
  EXPECT_EQ(At(1.02, 15.0), State::kObstacle);
  EXPECT_EQ(At(1.02, 15.1), State::kUnseen);
  EXPECT_EQ(At(0.5, 15.1), State::kUnseen);
  EXPECT_THAT(layer_.Marks({}, 15.1), testing::IsEmpty());
}

TEST_F(ObstacleLayerTest, MarksStayWhereTheyAreWhileTheRobotDrives) {
  Insert(0.0, 1.01f);
  Insert(1.0, kNothing, {0.0, 0.0, geometry::kPi / 2});  // it turns away
  EXPECT_EQ(At(1.02, 1.0), State::kObstacle);
  EXPECT_THAT(layer_.Marks({0.5, 0.0, 0.0}, 1.0), testing::SizeIs(1));
  EXPECT_THAT(layer_.Marks({-2.1, 0.0, 0.0}, 1.0), testing::IsEmpty()) << "too far away";
}

TEST_F(ObstacleLayerTest, FarAwayCellsAreOthersThanThoseHere) {
  Insert(0.0, 1.01f);
  for (int i = 1; i < 60; ++i) {
    EXPECT_NE(At(1.02 + 0.05 * 16 * i), State::kObstacle) << "the grid's memory wraps round " << i;
  }
  EXPECT_NE(layer_.At({-1e6, 1e6}, 0.0), State::kObstacle);
}

/// A second road: points along the beams, 1 mm apart.
TEST_F(ObstacleLayerTest, BeamsInAnyDirectionClearWhatTheyPass) {
  base::Rng rng(7);
  for (int i = 0; i < 200; ++i) {
    ObstacleLayer layer({2.5, 3.0, 10.0}, 0.05);
    const Pose2 X_OB{rng.Uniform(-20, 20), rng.Uniform(-20, 20), rng.Uniform(-3.1, 3.1)};
    const Pose2 X_BL{rng.Uniform(-0.3, 0.3), rng.Uniform(-0.3, 0.3), rng.Uniform(-3.1, 3.1)};
    const double range = rng.Uniform(0.8, 2.4);
    layer.Insert(0.0, Ahead(static_cast<float>(range)), X_OB, X_BL, kFootprint);
    const Pose2 X_OL = X_OB * X_BL;
    const Vector2d echo = X_OL * Vector2d(static_cast<float>(range), 0.0);
    EXPECT_EQ(layer.At(echo, 0.0), State::kObstacle);
    for (double way = 0.0; way < range - 0.08; way += 0.001) {
      EXPECT_EQ(layer.At(X_OL * Vector2d(way, 0.0), 0.0), State::kFree) << i << " at " << way;
    }
  }
}

}  // namespace
}  // namespace hires::navigation::obstacle_layer_test
