#include "hires/simulation/robot_clearance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "hires/robot/robot_profile.h"
#include "hires/simulation/scene.h"
#include "support/scenes.h"

namespace hires::simulation::robot_clearance_test {
namespace {

using test_support::Block;
using test_support::Shape;

/// A box of 0.60 x 0.50 m on the floor.
const std::vector<geometry::Collision>& BoxRobot() {
  static const std::vector<geometry::Collision> shapes{
      Shape("hull", geometry::Box{{0.6, 0.5, 0.3}}, {0.0, 0.0, 0.15})};
  return shapes;
}

world::World WorldOf(std::vector<world::StaticBody> statics) {
  world::World world;
  world.statics = std::move(statics);
  return world;
}

geometry::Polygon OutlineOf(const geometry::Collision& shape, const geometry::Pose3& X_MB) {
  const geometry::Pose3 X_MS = X_MB * shape.X_BS;
  const geometry::Aabb bounds = geometry::BoundsOf(shape.shape, X_MS);
  return *geometry::OutlineInBand(shape.shape, X_MS, bounds.lower.z(), bounds.upper.z());
}

TEST(RobotClearanceTest, MeasuresFaceToFace) {
  const RobotClearance clearance(BoxRobot(),
                                 WorldOf({Block("crate", {1.0, 1.0, 1.0}, {2.0, 0.0, 0.5})}));
  EXPECT_NEAR(clearance.Clearance({}, 5.0), 1.5 - 0.3, 1e-12);
  EXPECT_NEAR(clearance.Clearance({0.0, 0.0, geometry::kPi / 2}, 5.0), 1.5 - 0.25, 1e-12);
  EXPECT_NEAR(clearance.Clearance({0.7, 0.2, 0.0}, 5.0), 0.5, 1e-12);
}

TEST(RobotClearanceTest, MeasuresCornerToFaceAndCornerToCorner) {
  const RobotClearance clearance(BoxRobot(),
                                 WorldOf({Block("crate", {1.0, 1.0, 1.0}, {2.0, 0.0, 0.5})}));
  const double reach = (0.3 + 0.25) / std::sqrt(2.0);
  EXPECT_NEAR(clearance.Clearance({0.0, 0.0, geometry::kPi / 4}, 5.0), 1.5 - reach, 1e-12);
  EXPECT_NEAR(clearance.Clearance({0.8, 1.15, 0.0}, 5.0), std::hypot(0.4, 0.4), 1e-12);
}

TEST(RobotClearanceTest, NeverSaysMoreThanTheLimit) {
  const RobotClearance clearance(BoxRobot(),
                                 WorldOf({Block("crate", {1.0, 1.0, 1.0}, {2.0, 0.0, 0.5})}));
  EXPECT_EQ(clearance.Clearance({}, 0.7), 0.7);
  EXPECT_EQ(RobotClearance(BoxRobot(), world::World()).Clearance({}, 0.7), 0.7);
}

TEST(RobotClearanceTest, NamesWhatTouches) {
  const RobotClearance clearance(BoxRobot(),
                                 WorldOf({Block("far", {1.0, 1.0, 1.0}, {9.0, 0.0, 0.5}),
                                          Block("crate", {1.0, 1.0, 1.0}, {2.0, 0.0, 0.5})}));
  EXPECT_FALSE(clearance.FindContact({1.19, 0.0, 0.0}));
  const auto contact = clearance.FindContact({1.21, 0.0, 0.0});
  ASSERT_TRUE(contact);
  EXPECT_EQ(contact->robot_part, "hull");
  EXPECT_EQ(contact->obstacle, "crate");
  EXPECT_EQ(clearance.Clearance({1.21, 0.0, 0.0}, 1.0), 0.0);
}

TEST(RobotClearanceTest, ACompletelyCoveredRobotTouches) {
  const RobotClearance clearance(BoxRobot(),
                                 WorldOf({Block("hall", {20.0, 20.0, 2.0}, {0.0, 0.0, 1.0})}));
  EXPECT_TRUE(clearance.FindContact({1.0, 2.0, 0.3}));
}

TEST(RobotClearanceTest, TheBaseFitsUnderATableTheTorsoDoesNot) {
  // The slab hangs at 0.70 .. 0.73 m over x >= 1; the base ends at 0.30 m, the torso reaches up to
  // 1.20 m and forward to -0.05.
  const Scene scene = *MakeScene(WorldOf({Block("slab", {1.0, 2.0, 0.03}, {1.5, 0.0, 0.715})}),
                                 test_support::TrayRobot());
  EXPECT_FALSE(scene.clearance.FindContact({1.0, 0.0, 0.0}));
  EXPECT_NEAR(scene.clearance.Clearance({1.0, 0.0, 0.0}, 1.0), 0.05, 1e-12);
  const auto contact = scene.clearance.FindContact({1.1, 0.0, 0.0});
  ASSERT_TRUE(contact);
  EXPECT_EQ(contact->robot_part, "base/torso");
  EXPECT_EQ(contact->obstacle, "slab");
}

TEST(RobotClearanceTest, ACylinderCountsAsItsCircleOrALittleMore) {
  world::StaticBody pillar;
  pillar.name = "pillar";
  pillar.X_MB.translation = {2.0, 0.0, 0.5};
  pillar.collisions = {Shape("shaft", geometry::Cylinder{0.2, 1.0}, {0.0, 0.0, 0.0})};
  const RobotClearance clearance(BoxRobot(), WorldOf({pillar}));
  for (int i = 0; i < 60; ++i) {  // the outline's corners point everywhere once
    const double turn = i * geometry::kPi / 30;
    const geometry::Pose2 X_MB = geometry::Pose2{2.0, 0.0, turn} * geometry::Pose2{-1.0, 0.0, 0.0};
    const double distance = clearance.Clearance(X_MB, 5.0);
    EXPECT_LE(distance, 0.5 + 1e-12) << "turn " << turn;
    EXPECT_GE(distance, 0.5 - 0.2 * 0.0087) << "turn " << turn;
  }
}

TEST(RobotClearanceTest, TurningRobotAndWorldTogetherChangesNothing) {
  base::Rng rng(11);
  for (int i = 0; i < 100; ++i) {
    world::StaticBody crate = Block("crate", {0.4, 0.9, 1.0}, {0.0, 0.0, 0.5});
    const geometry::Pose2 X_MC{1.2, rng.Uniform(-1.0, 1.0), rng.Uniform(-3.0, 3.0)};
    const geometry::Pose2 X_MB{0.0, 0.0, rng.Uniform(-3.0, 3.0)};
    const geometry::Pose2 X_NM{rng.Uniform(-5.0, 5.0), rng.Uniform(-5.0, 5.0),
                               rng.Uniform(-3.0, 3.0)};
    crate.X_MB = geometry::Lift(X_MC, 0.5);
    const double here = RobotClearance(BoxRobot(), WorldOf({crate})).Clearance(X_MB, 3.0);
    crate.X_MB = geometry::Lift(X_NM * X_MC, 0.5);
    EXPECT_NEAR(RobotClearance(BoxRobot(), WorldOf({crate})).Clearance(X_NM * X_MB, 3.0), here,
                1e-9);
  }
}

TEST(RobotClearanceTest, IsTheLeastDistanceOfTheOutlinesToTheLastBit) {
  base::Rng rng(13);
  for (int i = 0; i < 200; ++i) {
    std::vector<world::StaticBody> crates;
    std::vector<geometry::Polygon> outlines_M;
    for (int k = 0; k < 6; ++k) {
      const Eigen::Vector3d size(rng.Uniform(0.05, 3.0), rng.Uniform(0.05, 3.0), 1.0);
      const geometry::Pose2 X_MC{rng.Uniform(-3.0, 3.0), rng.Uniform(-3.0, 3.0),
                                 rng.Uniform(-3.0, 3.0)};
      crates.push_back(Block("crate", size, {0.0, 0.0, 0.5}));
      crates.back().X_MB = geometry::Lift(X_MC, 0.5);
      outlines_M.push_back(OutlineOf(crates.back().collisions[0], crates.back().X_MB));
    }
    const geometry::Pose2 X_MB{rng.Uniform(-3.0, 3.0), rng.Uniform(-3.0, 3.0),
                               rng.Uniform(-3.0, 3.0)};
    const geometry::Polygon robot_M = geometry::Transformed(X_MB, OutlineOf(BoxRobot()[0], {}));
    const double limit = rng.Uniform(0.0, 1.0);
    double least = limit;
    for (const geometry::Polygon& outline_M : outlines_M) {
      least = std::min(least, geometry::Distance(robot_M, outline_M));
    }
    const RobotClearance clearance(BoxRobot(), WorldOf(crates));
    EXPECT_EQ(clearance.Clearance(X_MB, limit), least) << "case " << i;
    EXPECT_EQ(clearance.FindContact(X_MB).has_value(), least == 0.0) << "case " << i;
  }
}

TEST(RobotClearanceTest, WestOfTable2ThePr2StandsBesideChair2) {
  const std::string root = HIRES_SOURCE_DIR;
  const auto scene = MakeScene(world::LoadWorld(root + "/worlds/restaurant.world"),
                               robot::LoadRobot(root + "/config/robots/pr2.yaml"));
  const geometry::Pose2 X_MB =
      geometry::Flatten(*scene->world.FindFrame("preManipulationAreaWestTable2"));
  EXPECT_NEAR(scene->clearance.Clearance(X_MB, 1.0), 0.14, 0.01);
  const auto contact = scene->clearance.FindContact(X_MB * geometry::Pose2{-0.15, 0.0, 0.0});
  ASSERT_TRUE(contact);
  EXPECT_EQ(contact->obstacle, "chair2");
}

}  // namespace
}  // namespace hires::simulation::robot_clearance_test
