#include "hires/manipulation/grasp.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hires/geometry/angles.h"
#include "restaurant_scene.h"

namespace hires::manipulation::grasp_test {
namespace {

using geometry::Pose3;
using ::testing::Contains;
using ::testing::Field;
using ::testing::IsEmpty;
using ::testing::Not;

robot::GripperProfile Gripper() { return test_support::Pr2()->profile.upper_body->gripper; }

world::ObjectModel Can(double radius, double height) {
  world::ObjectModel can;
  can.name = "can";
  geometry::Collision body;
  body.shape = geometry::Cylinder{radius, height};
  body.X_BS.translation = {0.0, 0.0, 0.5 * height};
  can.collisions = {body};
  can.mass_properties.p_BBcm = {0.0, 0.0, 0.5 * height};
  return can;
}

/// Every kind of object of the catalogue, by name.
std::map<std::string, std::shared_ptr<const world::ObjectModel>> Catalogue() {
  std::map<std::string, std::shared_ptr<const world::ObjectModel>> models;
  for (const auto& [name, model] :
       world::LoadCatalogueModels(test_support::kSource + "/worlds/objects.yaml")) {
    models[model->name] = model;
  }
  return models;
}

double LowestPoint(const world::ObjectModel& object) {
  double lowest = 1e9;
  for (const geometry::Collision& part : object.collisions) {
    lowest = std::min(lowest, geometry::BoundsOf(part.shape, part.X_BS).lower.z());
  }
  return lowest;
}

/// Parallel jaws: an object fits between them as deep as the palm allows, whatever its width.
TEST(GraspsForTest, ParallelFingersTakeFromAboveUpToThePalm) {
  robot::GripperProfile jaws;
  jaws.fingers = robot::FingerMotion::kSliding;
  jaws.max_gap = 0.10;
  jaws.shape = {0.03, 0.05, 0.013, 0.013, 0.09, 0.10, 0.0};
  for (const double radius : {0.02, 0.044}) {
    const world::ObjectModel can = Can(radius, 0.20);
    const auto grasps = GraspsFor(can, jaws, 4);
    const auto top = std::find_if(grasps.begin(), grasps.end(),
                                  [](const Grasp& grasp) { return grasp.kind == "top"; });
    ASSERT_NE(top, grasps.end()) << radius;
    EXPECT_NEAR(top->X_OT.translation.z(), 0.20 - 0.05 + kGraspClearance, 1e-9);
    EXPECT_NEAR(top->gap, 2.0 * radius, 0.001);
  }
  EXPECT_THAT(GraspsFor(Can(0.046, 0.2), jaws, 4), IsEmpty());
}

TEST(GraspsForTest, AGraspFromTheSideOfACanMeetsItsAxis) {
  for (const Grasp& grasp : GraspsFor(Can(0.035, 0.20), Gripper())) {
    if (grasp.kind != "side") continue;
    EXPECT_NEAR(grasp.X_OT.translation.head<2>().norm(), 0.0, 1e-9);
    // Round shapes count as the polygon around them.
    EXPECT_NEAR(grasp.gap, 0.07, 0.001);
    const Eigen::Vector3d up_T = grasp.X_OT.rotation.conjugate() * Eigen::Vector3d::UnitZ();
    EXPECT_NEAR(up_T.z(), 1.0, 1e-12) << "the fingers open across";
  }
}

TEST(GraspsForTest, AGraspFromAbovePointsDown) {
  const auto grasps = GraspsFor(Can(0.035, 0.20), Gripper());
  ASSERT_THAT(grasps, Contains(Field(&Grasp::kind, "top")));
  for (const Grasp& grasp : grasps) {
    if (grasp.kind != "top") continue;
    EXPECT_NEAR((grasp.X_OT.rotation * Eigen::Vector3d::UnitX()).z(), -1.0, 1e-12);
    EXPECT_LT(grasp.X_OT.translation.z(), 0.20);
    EXPECT_GT(grasp.X_OT.translation.z(), 0.20 - robot::FingerShape{}.palm_distance);
  }
}

TEST(GraspsForTest, AllHeadingsAreTried) {
  std::set<long> headings;
  for (const Grasp& grasp : GraspsFor(Can(0.03, 0.2), Gripper(), 12)) {
    if (grasp.kind != "side") continue;
    headings.insert(std::lround(geometry::YawOf(grasp.X_OT.rotation) * 180 / geometry::kPi));
  }
  EXPECT_EQ(headings.size(), 12u);
}

TEST(GraspsForTest, WhatIsWiderThanTheGripperOpensHasNone) {
  EXPECT_THAT(GraspsFor(Can(0.05, 0.2), Gripper()), IsEmpty());
  EXPECT_THAT(GraspsFor(Can(0.042, 0.2), Gripper()), Not(IsEmpty()));
  robot::GripperProfile small = Gripper();
  small.max_gap = 0.06;
  EXPECT_THAT(GraspsFor(Can(0.035, 0.2), small), IsEmpty());
}

TEST(GraspsForTest, AFlatThingIsTakenFromAboveOnly) {
  for (const Grasp& grasp : GraspsFor(Can(0.03, 0.04), Gripper())) EXPECT_EQ(grasp.kind, "top");
}

TEST(GraspsForTest, ABookIsTakenAcrossItsBackOnly) {
  world::ObjectModel book = Can(0.01, 0.175);
  book.collisions[0].shape = geometry::Box{{0.11, 0.045, 0.175}};
  for (const Grasp& grasp : GraspsFor(book, Gripper(), 4)) {
    EXPECT_NEAR(grasp.gap, 0.045, 1e-9);
    const Eigen::Vector3d across_O = grasp.X_OT.rotation * Eigen::Vector3d::UnitY();
    EXPECT_NEAR(std::abs(across_O.y()), 1.0, 1e-9);
    if (grasp.kind == "side") {
      // 0.055 deep to its middle: the palm would be met before.
      EXPECT_GT(grasp.X_OT.translation.head<2>().norm(), 0.01);
    }
  }
}

TEST(GraspsForTest, TheBestSideGraspIsNearTheCentreOfMass) {
  const auto grasps = GraspsFor(Can(0.037, 0.274), Gripper());
  ASSERT_THAT(grasps, Not(IsEmpty()));
  EXPECT_EQ(grasps.front().kind, "side");
  EXPECT_NEAR(grasps.front().X_OT.translation.z(), 0.137, 0.01);
}

TEST(GraspsForTest, TheSameTwice) {
  const auto a = GraspsFor(Can(0.03, 0.1), Gripper()), b = GraspsFor(Can(0.03, 0.1), Gripper());
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].X_OT.translation, b[i].X_OT.translation);
    EXPECT_EQ(a[i].X_OT.rotation.coeffs(), b[i].X_OT.rotation.coeffs());
  }
}

TEST(GraspsForTest, NoHeadingIsTheCallersFault) {
  EXPECT_THROW(GraspsFor(Can(0.03, 0.1), Gripper(), 0), std::logic_error);
}

TEST(GraspsForCatalogueTest, EveryGraspKeepsItsPromises) {
  const robot::FingerShape fingers;
  for (const auto& [name, model] : Catalogue()) {
    double last = 1.0;
    const double face = LowestPoint(*model);
    for (const Grasp& grasp : GraspsFor(*model, Gripper())) {
      EXPECT_GT(grasp.gap, 0.0) << name;
      EXPECT_LE(grasp.gap, Gripper().max_gap) << name;
      EXPECT_GT(grasp.quality, 0.0) << name;
      EXPECT_LE(grasp.quality, last) << name << ": not the best first";
      last = grasp.quality;
      // The fingers' lowest point, at the grasp and all along the approach.
      const Eigen::Vector3d down_O = -Eigen::Vector3d::UnitZ();
      const Eigen::Vector3d down_T = grasp.X_OT.rotation.conjugate() * down_O;
      const double reach = fingers.tip_reach * std::max(0.0, down_T.x()) +
                           fingers.half_height * std::abs(down_T.z());
      for (const double back : {0.0, 0.5 * grasp.approach, grasp.approach}) {
        const Pose3 X_TBack{{-back, 0.0, 0.0}, Eigen::Quaterniond::Identity()};
        const double lowest = (grasp.X_OT * X_TBack).translation.z() - reach;
        EXPECT_GE(lowest, face + kGraspClearance - 1e-9) << name << " " << grasp.kind;
      }
    }
  }
}

TEST(GraspsForCatalogueTest, WhatIsServedCanBeTaken) {
  const auto models = Catalogue();
  for (const std::string name : {"coffee_cup", "peppermill_thesis", "peppermill_appendix",
                                 "peppermill_repository", "coke_can", "vase", "book"}) {
    EXPECT_THAT(GraspsFor(*models.at(name), Gripper()), Not(IsEmpty())) << name;
  }
}

}  // namespace
}  // namespace hires::manipulation::grasp_test
