#include "simulation/loose_objects.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "hires/world/unknown_box.h"
#include "support/scenes.h"

namespace hires::simulation::loose_objects_test {
namespace {

using geometry::Pose3;
using ::testing::ElementsAre;
using ::testing::SizeIs;

world::ObjectState MillAt(const std::string& name, double x) {
  world::ObjectState object;
  object.name = name;
  object.model = "mill";
  object.X_MO.translation = {x, 1.0, 0.0};
  object.V_MO.linear = {0.1, 0.0, 0.0};
  return object;
}

const Pose3 kBase = geometry::Lift({4.0, 3.0, 0.0});
const Pose3 kInBase = geometry::Lift({0.5, 0.1, 0.0}, 0.8);

/// mill1 stands about, mill2 on the robot, mill3 is part of it.
class LooseObjectsTest : public ::testing::Test {
 protected:
  LooseObjectsTest() {
    physics_.AddFloor(1.0);
    variation_.mass_factor = 2.0;
    variation_.friction_factor = 0.5;
    objects_.emplace(room_, variation_, &physics_);
    objects_->AddLoose(MillAt("mill1", 1.0), kInBase, false);
    objects_->AddLoose(MillAt("mill2", 2.0), kInBase, true);
    world::ObjectState held = MillAt("mill3", 3.0);
    held.attached_to = "tray";
    objects_->AddRigid(held, kInBase);
  }

  world::World room_ = test_support::Room();
  physics::PhysicsWorld physics_{physics::PhysicsParams()};
  Variation variation_;
  std::optional<LooseObjects> objects_;
};

TEST_F(LooseObjectsTest, KeepTheirOrder) {
  EXPECT_THAT(objects_->names(), ElementsAre("mill1", "mill2", "mill3"));
  EXPECT_THAT(objects_->carried(), ElementsAre(1));
  EXPECT_EQ(objects_->AtStart(2).attached_to, "tray");
}

TEST_F(LooseObjectsTest, LooseOnesAreWherePhysicsHasThemOthersWhereTheBaseIs) {
  EXPECT_TRUE(objects_->IsLoose(0));
  EXPECT_NEAR(objects_->PoseOf(0, kBase).translation.x(), 1.0, 1e-12);
  EXPECT_NEAR(objects_->VelocityOf(0).linear.x(), 0.1, 1e-12);
  EXPECT_FALSE(objects_->IsLoose(2));
  EXPECT_EQ(objects_->PoseOf(2, kBase).translation, (kBase * kInBase).translation);
  EXPECT_EQ(objects_->VelocityOf(2).linear, Eigen::Vector3d::Zero());
}

TEST_F(LooseObjectsTest, ABoxThatAModelSaysIsAsHeavyAsItIsLarge) {
  world::ObjectState box = MillAt("unknown1", 5.0);
  box.model = "unknown_0.120x0.080x0.200";
  objects_->AddLoose(box, kInBase, false);
  EXPECT_NEAR(objects_->Graspable().back().mass, 2.0 * world::kUnknownDensity * 0.12 * 0.08 * 0.2,
              1e-12);
}

TEST_F(LooseObjectsTest, WhatRollsHasItsMiddleWhereItsModelSays) {
  variation_.com_offset = {0.002, 0.001};
  variation_.com_height_factor = 1.1;
  objects_.emplace(room_, variation_, &physics_);
  world::ObjectState lying = MillAt("mill4", 1.0);
  lying.X_MO.rotation = geometry::RotationFromRpy(0.0, 1.5707963267948966, 0.0);
  world::ObjectState held = lying;
  held.attached_to = "hand";
  for (const world::ObjectState& mill : {MillAt("mill5", 2.0), lying, held})
    objects_->AddLoose(mill, kInBase, false);
  EXPECT_EQ(objects_->RollingOf(0), geometry::Rolling::kNot);
  EXPECT_EQ(objects_->RollingOf(1), geometry::Rolling::kAlongALine);
  EXPECT_EQ(objects_->RollingOf(2), geometry::Rolling::kNot) << "it hangs in a hand";
  const Eigen::Vector3d middle = room_.models.at("mill")->mass_properties.p_BBcm;
  EXPECT_EQ(objects_->Graspable()[1].p_OOcm, middle);
  EXPECT_EQ(objects_->Graspable()[1].mass, 2.0 * room_.models.at("mill")->mass_properties.mass);
  for (const int stands : {0, 2}) {
    EXPECT_NEAR(objects_->Graspable()[stands].p_OOcm.x(), 0.002, 1e-12);
    EXPECT_NEAR(objects_->Graspable()[stands].p_OOcm.z(), 1.1 * middle.z(), 1e-12);
  }
}

TEST_F(LooseObjectsTest, HaveTheMassAndFrictionOfTheVariation) {
  const double mass = room_.models.at("mill")->mass_properties.mass;
  ASSERT_THAT(objects_->Graspable(), SizeIs(3));
  EXPECT_EQ(objects_->Graspable()[0].mass, 2.0 * mass);
  EXPECT_EQ(objects_->Graspable()[0].body, objects_->BodyOf(0));
  EXPECT_EQ(objects_->FrictionOf(0), 0.5 * room_.models.at("mill")->collisions[0].friction);
}

TEST_F(LooseObjectsTest, PartsOfTheRobotHaveShapesThatAreNamedByThem) {
  const std::vector<geometry::Collision> shapes = objects_->RigidShapes_B();
  ASSERT_THAT(shapes, SizeIs(1));
  EXPECT_EQ(shapes[0].name, "mill3");
  const Pose3& X_OS = room_.models.at("mill")->collisions[0].X_BS;
  EXPECT_EQ(shapes[0].X_BS.translation, (kInBase * X_OS).translation);
}

TEST_F(LooseObjectsTest, OnlyLooseOnesCanBePutElsewhere) {
  objects_->Put(0, {kInBase, {}});
  EXPECT_LT((objects_->PoseOf(0, kBase).translation - kInBase.translation).norm(), 1e-12);
  EXPECT_THROW(objects_->Put(2, {kInBase, {}}), std::logic_error);
}

}  // namespace
}  // namespace hires::simulation::loose_objects_test
