#include "hires/sensing/floor_watch.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hires/base/error.h"
#include "hires/world/unknown_box.h"
#include "support/fake_frame_tree.h"
#include "support/planar_rays.h"
#include "support/scenes.h"
#include "support/sight_scenes.h"
#include "support/tilt_sweep.h"

namespace hires::sensing::floor_watch_test {
namespace {

using geometry::Polygon;
using geometry::Pose2;
using test_support::FakeFrameTree;
using test_support::Room;
using test_support::TrayRobot;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Polygon Square(double x, double y, double edge) {
  const double h = edge / 2.0;
  return {{x - h, y - h}, {x + h, y - h}, {x + h, y + h}, {x - h, y + h}};
}

/// A chair's legs, 0.4 m apart, turned about its middle.
std::vector<Polygon> Chair(double x, double y, double yaw = 0.0) {
  std::vector<Polygon> legs;
  for (const double dx : {-0.2, 0.2}) {
    for (const double dy : {-0.2, 0.2})
      legs.push_back(
          geometry::Transformed(Pose2{x, y, yaw} * Pose2{dx, dy, 0.0}, Square(0.0, 0.0, 0.04)));
  }
  return legs;
}

class FloorWatchTest : public testing::Test {
 protected:
  static std::shared_ptr<const world::World> TheRoom() {
    return std::make_shared<const world::World>(Room());
  }
  FloorWatch Make(const FloorWatchParams& params = {}) const {
    return {&state_, TheRoom(), robot_, params};
  }
  /// Scans at 20 Hz, of what stands there and no walls.
  /// @return how often something changed.
  int Watch(double seconds, const std::vector<Polygon>& standing) {
    int changes = 0;
    for (int i = 0; i < std::lround(20.0 * seconds); ++i) {
      time_ += 0.05;
      tree_->Tell("map", "odom", time_, {});
      state_.OnTransforms(time_);
      state_.OnOdometry(time_, "odom", "", {X_MB_, {}});
      state_.OnJoints(time_, {{{"a", 1.0}}, {{"a", 0.5}}});
      robot::ScanReading scan{-0.5 * M_PI, M_PI / 360.0, 0.08, {}};
      for (int k = 0; k <= 360; ++k) {
        const double range = hires::test_support::RangeTo(
            standing, X_MB_.position(), X_MB_.yaw + scan.angle_min + k * scan.angle_increment);
        scan.ranges.push_back(static_cast<float>(range + rng_.Normal(0.0, 0.01)));
      }
      watch_.OnScan(time_, "base", std::move(scan));
      changes += watch_.Update(time_);
    }
    return changes;
  }
  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    for (const robot::SeenObject& thing : watch_.things()) names.push_back(thing.name);
    return names;
  }

  std::shared_ptr<FakeFrameTree> tree_ = std::make_shared<FakeFrameTree>();
  std::shared_ptr<const robot::Robot> robot_ = std::make_shared<const robot::Robot>(TrayRobot());
  RobotStateEstimator state_{robot_, {"map", "odom", "base"}, {}, {}, tree_};
  FloorWatch watch_ = Make();
  Pose2 X_MB_{2.5, 2.0, 0.0};  // the east wall stands at x = 6
  base::Rng rng_{3};
  double time_{1.0};
};

TEST_F(FloorWatchTest, AChairThatIsNotInTheWorldIsOneThingAfterAWhile) {
  Watch(4.8, Chair(4.0, 2.2, 0.3));
  EXPECT_THAT(Names(), IsEmpty()) << "shadows last that long";
  Watch(0.6, Chair(4.0, 2.2, 0.3));
  ASSERT_THAT(Names(), ElementsAre("obstacle1"));
  const robot::SeenObject& chair = watch_.things()[0];
  EXPECT_NEAR(chair.X_MO.translation.x(), 4.0, 0.05);
  EXPECT_NEAR(chair.X_MO.translation.y(), 2.2, 0.05);
  EXPECT_EQ(chair.X_MO.translation.z(), 0.0);
  EXPECT_THAT(chair.model, HasSubstr("x0.400")) << "its height";
  const int changes = Watch(20.0, Chair(4.0, 2.2, 0.3));
  EXPECT_LE(changes, 2) << "what stands still is told once";
  EXPECT_THAT(Names(), ElementsAre("obstacle1"));
}

TEST_F(FloorWatchTest, WhatIsGoneIsForgottenWhereTheLaserSeesThroughIt) {
  Watch(6.0, Chair(4.0, 2.2));
  Watch(0.8, {});
  EXPECT_THAT(Names(), ElementsAre("obstacle1")) << "a moment is nothing";
  Watch(0.8, {});
  EXPECT_THAT(Names(), IsEmpty());
  EXPECT_THAT(watch_.vanished(), ElementsAre("obstacle1"));
  Watch(6.0, Chair(3.5, 1.0));
  EXPECT_THAT(Names(), ElementsAre("obstacle1"));
  EXPECT_THAT(watch_.vanished(), IsEmpty());
}

TEST_F(FloorWatchTest, WhatIsHiddenOrBehindTheRobotStays) {
  Watch(6.0, Chair(4.0, 2.2));
  Watch(3.0, {Square(3.3, 2.1, 0.6)});  // somebody stands before it
  EXPECT_THAT(Names(), ElementsAre("obstacle1"));
  X_MB_.yaw = M_PI;
  Watch(5.0, {});
  EXPECT_THAT(Names(), ElementsAre("obstacle1"));
}

TEST_F(FloorWatchTest, ThingsApartAreSeveralAndKeepTheirNames) {
  std::vector<Polygon> both = Chair(4.0, 2.8);
  for (const Polygon& leg : Chair(4.2, 1.2)) both.push_back(leg);
  Watch(6.0, both);
  ASSERT_THAT(Names(), ElementsAre("obstacle1", "obstacle2"));
  const double y1 = watch_.things()[0].X_MO.translation.y();
  Watch(3.0, y1 > 2.0 ? Chair(4.2, 1.2) : Chair(4.0, 2.8));
  EXPECT_THAT(Names(), ElementsAre("obstacle2"));
  EXPECT_THAT(watch_.vanished(), testing::Contains("obstacle1"));
}

TEST_F(FloorWatchTest, NoBoxReachesIntoWhatIsKnown) {
  // Two posts on both sides of a pillar are no thing that goes through it.
  auto world = std::make_shared<world::World>(Room());
  world::StaticBody pillar;
  pillar.name = "pillar";
  pillar.X_MB.translation = {4.0, 2.0, 0.5};
  pillar.collisions.emplace_back();
  pillar.collisions.back().shape = geometry::Box{{0.04, 0.04, 1.0}};
  world->statics.push_back(pillar);
  FloorWatchParams params;
  params.tolerance = 0.05;
  watch_ = FloorWatch(&state_, world, robot_, params);
  Watch(6.0, {Square(4.0, 2.2, 0.06), Square(4.0, 1.8, 0.06), Square(4.0, 2.0, 0.04)});
  ASSERT_THAT(Names(), ElementsAre("obstacle1", "obstacle2"));
  for (const robot::SeenObject& thing : watch_.things())
    EXPECT_NEAR(std::abs(thing.X_MO.translation.y() - 2.0), 0.2, 0.05);
}

TEST_F(FloorWatchTest, WallsOfTheWorldAndScansWithoutASenseAreNothing) {
  X_MB_ = {4.0, 2.0, 0.0};
  Watch(8.0, {Square(6.05, 2.0, 0.3)});  // the wall, but for an error of 0.1 m
  EXPECT_THAT(Names(), IsEmpty());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  watch_.OnScan(time_ + 0.01, "base", {0.0, 0.01, 0.08, {nan, nan, -1.0F}});
  watch_.OnScan(time_ + 0.02, "base", {0.0, 0.01, 0.08, {}});
  watch_.OnScan(time_ + 0.03, "nose", {0.0, 0.01, 0.08, {1.0F}});
  EXPECT_FALSE(watch_.Update(time_ + 0.03));
  EXPECT_EQ(watch_.OnScan(0.0, "base", {}).what, Reception::kNoStamp);
}

/// A robot with a laser that nods over its torso, and no other.
class FloorByCloudsTest : public testing::Test {
 protected:
  FloorByCloudsTest() {
    GroundWatchParams ground;
    ground.is_enabled = true;
    ground.eye = "";
    watch_.emplace(&state_, std::make_shared<const world::World>(Room()), robot_,
                   FloorWatchParams{}, ground);
    tree_->TellFixed("base", "laser", kLaser);
  }
  /// Sweeps, one each 2.3 s.
  /// @return how often something changed.
  int Sweep(int num, const std::vector<world::StaticBody>& standing) {
    int changes = 0;
    world::World room = Room();
    for (const world::StaticBody& body : standing) room.statics.push_back(body);
    const perception::LineOfSight sight(std::make_shared<perception::Surroundings>(room), {});
    for (int i = 0; i < num; ++i) {
      for (int tick = 0; tick < 23; ++tick) Stand(time_ += 0.1);
      watch_->OnCloud(
          time_, "laser",
          test_support::TiltSweep{}.Measure(sight, geometry::Lift(X_MB_) * kLaser, &rng_));
      changes += watch_->Update(time_);
    }
    return changes;
  }
  void Stand(double time) {
    tree_->Tell("map", "odom", time, {});
    state_.OnTransforms(time);
    state_.OnOdometry(time, "odom", "", {X_MB_, {}});
    state_.OnJoints(time, {{{"a", 1.0}}, {{"a", 0.5}}});
  }
  const std::vector<robot::SeenObject>& Things() const { return watch_->things(); }

  const geometry::Pose3 kLaser = test_support::At(0.1, 0.0, 1.2);
  std::shared_ptr<FakeFrameTree> tree_ = std::make_shared<FakeFrameTree>();
  std::shared_ptr<const robot::Robot> robot_ = std::make_shared<const robot::Robot>(TrayRobot());
  RobotStateEstimator state_{robot_, {"map", "odom", "base"}, {}, {}, tree_};
  std::optional<FloorWatch> watch_;
  Pose2 X_MB_{2.5, 2.0, 0.0};
  base::Rng rng_{5};
  double time_{1.0};
};

using test_support::Block;

// Lower than the laser of a base looks.
TEST_F(FloorByCloudsTest, ALowBoxIsAsHighAndAsLargeAsItIsSeen) {
  const auto box = Block("box", {0.3, 0.4, 0.15}, {4.0, 2.2, 0.075});
  Sweep(1, {box});
  EXPECT_THAT(Things(), IsEmpty()) << "one look is not enough";
  Sweep(1, {box});
  ASSERT_EQ(Things().size(), 1u);
  EXPECT_EQ(Things()[0].name, "obstacle1");
  const Eigen::Vector3d p_M = Things()[0].X_MO.translation;
  EXPECT_NEAR((p_M - Eigen::Vector3d(4.0, 2.2, 0.0)).norm(), 0.0, 0.05) << p_M.transpose();
  const Eigen::Vector3d size = world::SizeOfUnknownBox(Things()[0].model);
  EXPECT_NEAR(std::min(size.x(), size.y()), 0.3, 0.06);
  EXPECT_NEAR(std::max(size.x(), size.y()), 0.4, 0.06);
  EXPECT_NEAR(size.z(), 0.15, 0.02);
  EXPECT_LE(Sweep(6, {box}), 1) << "what stands still is told once";
  EXPECT_EQ(Things().size(), 1u);
}

TEST_F(FloorByCloudsTest, WhatIsGoneIsForgottenWhereTheFloorIsSeen) {
  const auto box = Block("box", {0.3, 0.4, 0.15}, {4.0, 2.2, 0.075});
  Sweep(3, {box});
  Sweep(1, {});
  EXPECT_EQ(Things().size(), 1u) << "one look is not enough";
  Sweep(1, {});
  EXPECT_THAT(Things(), IsEmpty());
  EXPECT_THAT(watch_->vanished(), ElementsAre("obstacle1"));
}

TEST_F(FloorByCloudsTest, WhatIsHiddenStays) {
  const auto box = Block("box", {0.2, 0.2, 0.15}, {4.6, 2.0, 0.075});
  Sweep(3, {box});
  ASSERT_EQ(Things().size(), 1u);
  const std::string model = Things()[0].model;
  Sweep(3, {Block("person", {0.2, 0.8, 1.6}, {3.6, 2.0, 0.8})});
  const auto still = std::find_if(Things().begin(), Things().end(),
                                  [&](const auto& thing) { return thing.model == model; });
  ASSERT_NE(still, Things().end());
  EXPECT_NEAR(still->X_MO.translation.x(), 4.6, 0.1);
}

TEST_F(FloorByCloudsTest, WhatHangsInTheAirAndWhatIsFlatStandsNowhere) {
  Sweep(4, {Block("held", {0.1, 0.1, 0.2}, {3.5, 2.0, 0.9}),
            Block("rug", {1.0, 1.0, 0.01}, {4.2, 2.0, 0.005})});
  EXPECT_THAT(Things(), IsEmpty());
}

// What is told lower would be driven over where drives are imagined, and not by the robot.
TEST_F(FloorByCloudsTest, AThingThatIsHardlyHighEnoughIsToldAsHighAsDrivesNeed) {
  Sweep(3, {Block("step", {0.4, 0.4, 0.06}, {4.0, 2.0, 0.03})});
  ASSERT_EQ(Things().size(), 1u);
  EXPECT_EQ(world::SizeOfUnknownBox(Things()[0].model).z(), 0.1);
}

TEST_F(FloorByCloudsTest, ACloudOfAFrameThatNobodyKnowsIsNothingAndNamed) {
  Sweep(2, {});
  watch_->OnCloud(time_, "submarine", perception::PointCloud{1, 1, {{1.0F, 0.0F, 0.0F}}});
  EXPECT_FALSE(watch_->Update(time_));
  EXPECT_EQ(watch_->cloud_receipt().subject, "submarine");
}

TEST(FloorWatchParamsTest, AreReadAndCheckedByName) {
  const auto read = [](const std::string& changed) {
    const std::string all =
        "{enabled: true, range: 3, tolerance: 0.1, cell: 0.1, appear_after: 5, gap: 0.4, "
        "height: 0.4, min_change: 0.1}";
    return ReadFloorWatchParams(
        base::ParamReader::FromString(changed.empty() ? all : changed, "floor.yaml"));
  };
  EXPECT_EQ(read("").gap, 0.4);
  EXPECT_THROW(read("{enabled: true, range: -1}"), base::ConfigError);
  EXPECT_THROW(read("{range: 3}"), base::ConfigError);
}

}  // namespace
}  // namespace hires::sensing::floor_watch_test
