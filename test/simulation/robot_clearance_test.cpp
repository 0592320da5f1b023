#include "hires/simulation/robot_clearance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "hires/robot/robot_profile.h"
#include "hires/simulation/scene.h"
#include "support/box_mesh.h"
#include "support/rounds.h"
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

/// Boxes as one mesh of all their triangles.
geometry::Collision AsOneMesh(const std::vector<geometry::Collision>& boxes) {
  geometry::Collision all = boxes.front();
  auto mesh = std::make_shared<geometry::TriangleMesh>();
  for (const geometry::Collision& box : boxes) {
    const auto one = test_support::BoxMesh(std::get<geometry::Box>(box.shape).size);
    const int first = static_cast<int>(mesh->vertices.size());
    for (const Eigen::Vector3d& corner : one->vertices) mesh->vertices.push_back(box.X_BS * corner);
    for (const auto& t : one->triangles)
      mesh->triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  all.shape = std::shared_ptr<const geometry::TriangleMesh>(mesh);
  all.X_BS = {};
  return all;
}

std::vector<geometry::Collision> RandomBoxes(int count, double reach, base::Rng* rng) {
  std::vector<geometry::Collision> boxes;
  for (int k = 0; k < count; ++k) {
    boxes.push_back(Shape(
        "part",
        geometry::Box{{rng->Uniform(0.05, 1.0), rng->Uniform(0.05, 1.0), rng->Uniform(0.05, 0.6)}},
        {rng->Uniform(-reach, reach), rng->Uniform(-reach, reach), rng->Uniform(0.0, 1.0)}));
    boxes.back().X_BS.rotation =
        Eigen::AngleAxisd(rng->Uniform(-3.0, 3.0), Eigen::Vector3d::UnitZ());
  }
  return boxes;
}

TEST(RobotClearanceTest, BoxesTouchTheSameAsOneMesh) {
  base::Rng rng(17);
  int num_touching = 0;
  for (int i = 0; i < 60; ++i) {
    world::StaticBody house;
    house.name = "house";
    house.collisions = RandomBoxes(6, 2.0, &rng);
    world::StaticBody mesh_house = house;
    mesh_house.collisions = {AsOneMesh(house.collisions)};
    const std::vector<geometry::Collision> robot = RandomBoxes(3, 0.3, &rng);
    const std::vector<geometry::Collision> mesh_robot{AsOneMesh(robot)};
    const RobotClearance boxes(robot, WorldOf({house})), meshes(robot, WorldOf({mesh_house})),
        own(mesh_robot, WorldOf({house})), both(mesh_robot, WorldOf({mesh_house}));
    for (int k = 0; k < 50; ++k) {
      const geometry::Pose2 X_MB{rng.Uniform(-3.0, 3.0), rng.Uniform(-3.0, 3.0),
                                 rng.Uniform(-3.0, 3.0)};
      const bool touches = boxes.FindContact(X_MB).has_value();
      num_touching += touches ? 1 : 0;
      ASSERT_EQ(meshes.FindContact(X_MB).has_value(), touches) << i << " " << k;
      ASSERT_EQ(own.FindContact(X_MB).has_value(), touches) << i << " " << k;
      ASSERT_EQ(both.FindContact(X_MB).has_value(), touches) << i << " " << k;
    }
  }
  EXPECT_GT(num_touching, 300);
  EXPECT_LT(num_touching, 2700);
}

TEST(RobotClearanceTest, WhatAWallOfOneSurfaceGoesRoundIsFree) {
  // A ring: outer square of 4 m, inner one of 3.6 m, 1 m high, 16 corners, one closed surface.
  auto ring = std::make_shared<geometry::TriangleMesh>();
  for (const double z : {0.0, 1.0}) {
    for (const double half : {2.0, 1.8}) {
      for (const auto& [x, y] : {std::pair{1, 1}, {-1, 1}, {-1, -1}, {1, -1}})
        ring->vertices.emplace_back(x * half, y * half, z);
    }
  }
  const auto quad = [&](int a, int b, int c, int d) {
    ring->triangles.push_back({a, b, c});
    ring->triangles.push_back({a, c, d});
  };
  for (int k = 0; k < 4; ++k) {
    const int next = (k + 1) % 4;
    quad(k, next, 8 + next, 8 + k);            // outside
    quad(4 + next, 4 + k, 12 + k, 12 + next);  // inside
    quad(8 + k, 8 + next, 12 + next, 12 + k);  // above
    quad(next, k, 4 + k, 4 + next);            // below
  }
  world::StaticBody wall;
  wall.name = "wall";
  wall.collisions = {Shape("wall", std::shared_ptr<const geometry::TriangleMesh>(ring), {0, 0, 0})};
  const RobotClearance clearance(BoxRobot(), WorldOf({wall}));
  EXPECT_FALSE(clearance.FindContact({}));
  EXPECT_NEAR(clearance.Clearance({}, 3.0), 1.5, 1e-6);
  EXPECT_TRUE(clearance.FindContact({1.6, 0.0, 0.0}));
  EXPECT_TRUE(clearance.FindContact({2.2, 0.0, 0.0}));
  EXPECT_FALSE(clearance.FindContact({2.4, 0.0, 0.0}));
}

TEST(RobotClearanceTest, ASolidMeshCoversARobotWithinIt) {
  world::StaticBody hall;
  hall.name = "hall";
  hall.collisions = {Shape("hall", test_support::BoxMesh({20.0, 20.0, 2.0}), {0.0, 0.0, 1.0})};
  EXPECT_TRUE(RobotClearance(BoxRobot(), WorldOf({hall})).FindContact({1.0, 2.0, 0.3}));
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
  EXPECT_EQ(contact->obstacle, "chair2::back_rest");
}

/// A body of several boxes at random places around (3, 0).
world::StaticBody House(base::Rng* rng, bool as_mesh) {
  world::StaticBody house{"house", geometry::Lift({3.0, 0.0, rng->Uniform(-3.0, 3.0)}), {}};
  for (const char* name : {"coat_stand", "shelf", "stove"}) {
    geometry::Collision shape =
        Shape(name, geometry::Box{{rng->Uniform(0.1, 0.6), rng->Uniform(0.1, 0.6), 1.0}},
              {rng->Uniform(-2.0, 2.0), rng->Uniform(-2.0, 2.0), 0.5});
    if (as_mesh) {
      const Eigen::Vector3d size = std::get<geometry::Box>(shape.shape).size;
      shape.shape = test_support::BoxMesh(size);
    }
    house.collisions.push_back(shape);
  }
  return house;
}

TEST(RobotClearanceTest, AContactNamesTheShapeItsPlaceAndItsLine) {
  base::Rng rng(21);
  int num_contacts = 0;
  for (int i = 0; i < test_support::Rounds(400); ++i) {
    world::World world = WorldOf({House(&rng, i % 2 == 0)});
    for (const char* name : {"coat_stand", "shelf", "stove"})
      world.sources[std::string("house::") + name] = std::string(name) + ".world:3";
    const geometry::Pose2 X_MB{rng.Uniform(1.0, 5.0), rng.Uniform(-2.0, 2.0),
                               rng.Uniform(-3.0, 3.0)};
    const auto contact = RobotClearance(BoxRobot(), world).FindContact(X_MB);
    if (!contact) continue;
    ++num_contacts;
    const std::string shape = contact->obstacle.substr(std::string("house::").size());
    EXPECT_EQ(contact->source, shape + ".world:3");
    ASSERT_TRUE(contact->p_M);
    const auto is_near = [&](const geometry::Polygon& outline) {
      const geometry::Polygon point{*contact->p_M, *contact->p_M + Eigen::Vector2d(1e-9, 0.0),
                                    *contact->p_M + Eigen::Vector2d(0.0, 1e-9)};
      return geometry::Distance(outline, point) < 1e-3;
    };
    EXPECT_TRUE(is_near(geometry::Transformed(X_MB, OutlineOf(BoxRobot().front(), {}))));
    for (const geometry::Collision& part : world.statics.front().collisions) {
      if (part.name != shape) continue;
      EXPECT_TRUE(is_near(OutlineOf(part, world.statics.front().X_MB))) << contact->obstacle;
    }
    EXPECT_EQ(ToString(*contact).rfind("hull touches house::" + shape + " at x ", 0), 0u);
  }
  EXPECT_GT(num_contacts, 10);
}

TEST(RobotClearanceTest, WhatARobotStandsOnIsNoObstacleAndAStepIs) {
  base::Rng rng(22);
  for (int i = 0; i < test_support::Rounds(200); ++i) {
    const double sunk = rng.Uniform(0.0, 0.005), height = rng.Uniform(-0.01, 0.02);
    const std::vector<geometry::Collision> wheels{
        Shape("wheel", geometry::Cylinder{0.1, 0.2}, {0.0, 0.0, 0.1 - sunk})};
    world::StaticBody slab = Block("slab", {4.0, 4.0, 0.2}, {0.0, 0.0, height - 0.1});
    if (i % 2 == 0) slab.collisions.front().shape = test_support::BoxMesh({4.0, 4.0, 0.2});
    const bool is_step = height > 0.005 - sunk;
    const RobotClearance clearance(wheels, WorldOf({slab}));
    EXPECT_EQ(clearance.FindContact({rng.Uniform(-1.0, 1.0), 0.0, 0.0}).has_value(), is_step)
        << "sunk " << sunk << " height " << height;
  }
}

}  // namespace
}  // namespace hires::simulation::robot_clearance_test
