#include "sensing/ground/ground_obstacles.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "sensing/unmapped.h"
#include "support/scenes.h"
#include "support/sight_scenes.h"
#include "support/tilt_sweep.h"

namespace hires::sensing::ground_obstacles_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::Polygon;
using geometry::Pose2;
using geometry::Pose3;
using test_support::At;
using test_support::Block;
using ::testing::IsEmpty;
using ::testing::Not;

const Pose2 kRobot{3.0, 2.0, 0.0};       // in a room of x 0..6, y 0..4
const Pose3 kLaser = At(0.1, 0.0, 1.2);  // in the base
constexpr double kRobotHeight = 1.4;

GroundObstacles Finder() {
  const auto map = std::make_shared<const navigation::Costmap>(
      world::SliceWorld(test_support::Room(), 0.1, 0.9), 0.25, navigation::CostmapParams{});
  return {map, test_support::TrayRobot().profile.footprint, {}, {}};
}

/// The room, and what else stands in it.
struct Site {
  world::World world = test_support::Room();
  std::vector<Polygon> outlines;  ///< of what was added

  void Add(const Vector3d& size, const Vector3d& p_M, double yaw = 0.0) {
    world::StaticBody body = Block("thing" + std::to_string(outlines.size()), size, p_M);
    body.X_MB.rotation = geometry::RotationFromRpy(0.0, 0.0, yaw);
    outlines.push_back(
        *geometry::OutlineInBand(geometry::Box{size}, body.X_MB, p_M.z() - 9.0, p_M.z() + 9.0));
    world.statics.push_back(std::move(body));
  }
  /// @param X_FB  the base over the floor as it is: lifted and leaning by a little.
  GroundReading Read(const Pose3& X_FB, base::Rng* rng, double noise = 0.005) const {
    const perception::LineOfSight sight(std::make_shared<perception::Surroundings>(world), {});
    const test_support::TiltSweep sweep{320, 80, noise, 10.0};
    const auto cloud = sweep.Measure(sight, geometry::Lift(kRobot) * X_FB * kLaser, rng);
    return Finder().Find(cloud, kLaser, kRobot, kRobotHeight, rng);
  }
  GroundReading Read() const {
    base::Rng rng(1);
    return Read({}, &rng);
  }
};

std::vector<Polygon> SquaresOf(const GroundReading& reading) {
  std::vector<Polygon> squares;
  for (const GroundSpot& spot : reading.spots)
    squares.push_back(SquareOf(spot.cell.first, spot.cell.second, ScanParams{}.cell));
  return squares;
}

Vector2d MiddleOf(const Polygon& square) { return (square[0] + square[2]) / 2; }

double DistanceTo(const std::vector<Polygon>& outlines, const Polygon& square) {
  double distance = 1e9;
  for (const Polygon& outline : outlines) {
    distance = std::min(distance, geometry::Distance(outline, square));
  }
  return distance;
}

TEST(GroundObstaclesTest, AnEmptyRoomHasAFloorAndNoObstacle) {
  const GroundReading reading = Site().Read();
  EXPECT_TRUE(reading.floor.is_seen);
  EXPECT_NEAR(reading.floor.offset, 0.0, 0.001);
  EXPECT_NEAR(reading.floor.slope.norm(), 0.0, 0.001);
  EXPECT_THAT(SquaresOf(reading), IsEmpty());  // its walls are the map's
}

TEST(GroundObstaclesTest, AChairIsSquaresWhereItStands) {
  Site site;
  for (const double x : {4.0, 4.4}) {
    for (const double y : {2.1, 2.5}) site.Add({0.05, 0.05, 0.45}, {x, y, 0.225});
  }
  site.Add({0.45, 0.45, 0.04}, {4.2, 2.3, 0.47});
  const GroundReading reading = site.Read();
  EXPECT_THAT(SquaresOf(reading), Not(IsEmpty()));
  for (const Polygon& square : SquaresOf(reading)) {
    EXPECT_LT(DistanceTo(site.outlines, square), 0.02);
  }
}

TEST(GroundObstaclesTest, AStepUpAndAThickCableAreObstaclesAndAThinOneIsNone) {
  Site step;
  step.Add({0.5, 3.0, 0.06}, {4.5, 2.0, 0.03});
  EXPECT_THAT(SquaresOf(step.Read()), Not(IsEmpty()));
  Site cable;
  cable.Add({1.0, 0.045, 0.045}, {4.0, 2.2, 0.0225});
  EXPECT_THAT(SquaresOf(cable.Read()), Not(IsEmpty()));
  Site thin;  // robots of this size drive over it, and it drowns in the noise
  thin.Add({1.0, 0.008, 0.008}, {4.0, 2.2, 0.004});
  EXPECT_THAT(SquaresOf(thin.Read()), IsEmpty());
}

TEST(GroundObstaclesTest, WhatHangsHigherThanTheRobotIsNone) {
  Site site;
  site.Add({0.5, 0.5, 0.1}, {4.2, 2.0, 1.55});
  EXPECT_THAT(SquaresOf(site.Read()), IsEmpty());
  site.Add({0.5, 0.5, 0.1}, {4.2, 2.0, 1.30});
  EXPECT_THAT(SquaresOf(site.Read()), Not(IsEmpty()));
}

/// A platform of 0.3 m with a gap across; the robot stands on it, and the floor of the world is the
/// bottom of the gap.
TEST(GroundObstaclesTest, AHoleIsAnObstacleWhereItOpens) {
  Site site;
  site.world.statics = {Block("here", {4.0, 4.0, 0.3}, {2.0, 2.0, 0.15}),
                        Block("there", {1.5, 4.0, 0.3}, {5.25, 2.0, 0.15})};
  base::Rng rng(3);
  const GroundReading reading = site.Read(At(0.0, 0.0, 0.3), &rng);
  ASSERT_TRUE(reading.floor.is_seen);
  EXPECT_NEAR(reading.floor.offset, 0.0, 0.003);
  int num_in_gap = 0;
  for (const Polygon& square : SquaresOf(reading)) {
    const double x = MiddleOf(square).x();
    if (x > 3.97 && x < 4.53) ++num_in_gap;
    // Beyond both edges there is floor; where the platform ends to the sides there is none either.
    if (std::abs(MiddleOf(square).y() - 2.0) < 1.0) {
      EXPECT_GT(x, 3.97);
      EXPECT_LT(x, 4.53);
    }
  }
  EXPECT_GT(num_in_gap, 10);
}

TEST(GroundObstaclesTest, WhatLeansTheBaseIsFoundAndTakenOff) {
  for (int seed = 0; seed < 20; ++seed) {
    base::Rng rng(seed);
    const double roll = rng.Uniform(-0.02, 0.02), pitch = rng.Uniform(-0.02, 0.02);
    Pose3 X_FB = At(0.0, 0.0, rng.Uniform(-0.02, 0.02));
    X_FB.rotation = geometry::RotationFromRpy(roll, pitch, 0.0);
    const GroundReading reading = Site().Read(X_FB, &rng);
    ASSERT_TRUE(reading.floor.is_seen) << seed;
    // The floor lies in the base as the base does not lie over it.
    EXPECT_NEAR(reading.floor.slope.x(), pitch, 0.002) << seed;
    EXPECT_NEAR(reading.floor.slope.y(), -roll, 0.002) << seed;
    EXPECT_NEAR(reading.floor.offset, -X_FB.translation.z(), 0.003) << seed;
    EXPECT_THAT(SquaresOf(reading), IsEmpty()) << seed;
  }
}

TEST(GroundObstaclesTest, RandomThingsAreFoundAndNothingElse) {
  int num_things = 0;
  for (int seed = 0; seed < 40; ++seed) {
    base::Rng rng(100 + seed);
    Site site;
    // Side by side, so that none hides another; what is low and nearer than 0.8 m the sweep misses.
    for (int i = 0; i < 3; ++i) {
      const double x = rng.Uniform(1.0, 1.7), y = 0.8 * (i - 1) + rng.Uniform(-0.1, 0.1);
      const double height = rng.Uniform(0.06, 1.2);
      site.Add({rng.Uniform(0.05, 0.25), rng.Uniform(0.05, 0.25), height},
               {3.0 + x, 2.0 + y, height / 2}, rng.Uniform(-1.0, 1.0));
    }
    Pose3 X_FB;
    X_FB.rotation =
        geometry::RotationFromRpy(rng.Uniform(-0.01, 0.01), rng.Uniform(-0.01, 0.01), 0.0);
    const GroundReading reading = site.Read(X_FB, &rng);
    const std::vector<Polygon> squares = SquaresOf(reading);
    for (const Polygon& square : squares) {
      // The base leans and the robot does not know that: 0.01 rad of 1.2 m.
      ASSERT_LT(DistanceTo(site.outlines, square), 0.03) << "seed " << seed;
    }
    for (const Polygon& outline : site.outlines) {
      const bool is_found = std::any_of(squares.begin(), squares.end(), [&](const Polygon& square) {
        return geometry::Distance(outline, square) < 0.03;
      });
      ASSERT_TRUE(is_found) << "seed " << seed;
      ++num_things;
    }
  }
  EXPECT_EQ(num_things, 120);
}

TEST(GroundObstaclesTest, TheSameSeedGivesTheSameBits) {
  Site site;
  site.Add({0.2, 0.2, 0.5}, {4.2, 2.2, 0.25});
  base::Rng first(5), second(5);
  const GroundReading one = site.Read({}, &first), other = site.Read({}, &second);
  EXPECT_EQ(one.floor.offset, other.floor.offset);
  EXPECT_EQ(one.floor.slope, other.floor.slope);
  EXPECT_EQ(SquaresOf(one), SquaresOf(other));
}

TEST(GroundObstaclesTest, WithoutAFloorInSightTheBasesOwnIsTaken) {
  base::Rng rng(1);
  const perception::PointCloud nothing;
  const GroundReading none = Finder().Find(nothing, kLaser, kRobot, kRobotHeight, &rng);
  EXPECT_FALSE(none.floor.is_seen);
  EXPECT_THAT(SquaresOf(none), IsEmpty());
  // Four points of a thing 0.5 m high, 1 m before the robot.
  perception::PointCloud thing{4, 1, std::vector<Eigen::Vector3f>(4, {0.9f, 0.02f, -0.7f})};
  const GroundReading found = Finder().Find(thing, kLaser, kRobot, kRobotHeight, &rng);
  EXPECT_FALSE(found.floor.is_seen);
  ASSERT_EQ(SquaresOf(found).size(), 1u);
  EXPECT_TRUE(geometry::Contains(SquaresOf(found)[0], {4.0, 2.02}));
  thing.points.resize(2);
  EXPECT_THAT(SquaresOf(Finder().Find(thing, kLaser, kRobot, kRobotHeight, &rng)), IsEmpty());
}

TEST(GroundObstaclesTest, PointsOverTheFootprintAreTheRobotsOwn) {
  base::Rng rng(1);
  const perception::PointCloud own{4, 1, std::vector<Eigen::Vector3f>(4, {0.1f, 0.1f, -0.7f})};
  EXPECT_THAT(SquaresOf(Finder().Find(own, kLaser, kRobot, kRobotHeight, &rng)), IsEmpty());
}

}  // namespace
}  // namespace hires::sensing::ground_obstacles_test
