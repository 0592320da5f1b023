#include "hires/ros/middle_layer_senses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/scenes.h"

namespace hires_ros {
namespace {

using hires::geometry::Pose2;
using hires::test_support::Room;
using hires::test_support::TrayRobot;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::shared_ptr<const hires::navigation::Costmap> RoomMap() {
  return std::make_shared<const hires::navigation::Costmap>(
      hires::world::SliceWorld(Room(), 0.1, 0.9), 0.25, hires::navigation::CostmapParams{});
}

RobotNames Pr2Names() {
  return ReadRobotNames(std::string(HIRES_SOURCE_DIR) + "/config/robots/pr2_names.yaml");
}

/// A single beam, straight ahead.
hires::sensing::ScanReading Beam(double range) {
  return {0.0, 0.01, 0.08, {static_cast<float>(range)}};
}

class SensesTest : public ::testing::Test {
 protected:
  void TellBase(double stamp, const Pose2& X_OB = {}) {
    senses_.OnOdometry(stamp, {X_OB, {0.1, 0.2, 0.3}});
    senses_.OnJoints(stamp, {{{"a", 1.0}}, {{"a", 0.5}}});
  }

  std::shared_ptr<const hires::robot::Robot> robot_ =
      std::make_shared<const hires::robot::Robot>(TrayRobot());
  hires::sensing::ScanObstacles obstacles_{RoomMap(), robot_->profile.footprint, {}};
  Senses senses_{robot_, nullptr, obstacles_, Pr2Names(), 0.3};
};

TEST_F(SensesTest, NothingIsKnownUntilBaseJointsAndPlaceAre) {
  EXPECT_FALSE(senses_.CompleteUntil());
  EXPECT_EQ(senses_.Missing(), "base_odometry/odom");
  senses_.OnOdometry(1.0, {});
  EXPECT_EQ(senses_.Missing(), "joint_states");
  senses_.OnJoints(1.0, {});
  EXPECT_EQ(senses_.Missing(), "map -> odom_combined");
  senses_.OnLocalisation(1.0, {});
  EXPECT_EQ(senses_.CompleteUntil(), 1.0);
}

TEST_F(SensesTest, TheSlowestSensorSaysHowFarItIsComplete) {
  senses_.OnLocalisation(1.0, {});
  senses_.OnOdometry(1.2, {});
  senses_.OnJoints(1.1, {});
  EXPECT_EQ(senses_.CompleteUntil(), 1.1);
}

TEST_F(SensesTest, AnOldPlaceIsNone) {
  senses_.OnLocalisation(1.0, {});
  TellBase(1.3);
  EXPECT_TRUE(senses_.CompleteUntil());
  TellBase(1.31);
  EXPECT_FALSE(senses_.CompleteUntil());
}

TEST_F(SensesTest, AWordDatedAheadIsNoFresherForThat) {
  TellBase(1.0);
  senses_.OnLocalisation(3.0, {});  // came at 1.0
  TellBase(1.3);
  EXPECT_TRUE(senses_.CompleteUntil());
  TellBase(1.31);
  EXPECT_FALSE(senses_.CompleteUntil());
}

TEST_F(SensesTest, ThePlaceIsOdometryCorrected) {
  senses_.OnLocalisation(1.0, {2.0, 1.0, M_PI / 2});
  TellBase(1.0, {0.5, 0.0, 0.0});
  TellBase(1.01, {9.0, 9.0, 0.0});  // later than asked for
  const auto seen = senses_.Look(1.0);
  EXPECT_NEAR(seen.X_MB.x, 2.0, 1e-12);
  EXPECT_NEAR(seen.X_MB.y, 1.5, 1e-12);
  EXPECT_NEAR(seen.X_MB.yaw, M_PI / 2, 1e-12);
  EXPECT_EQ(seen.V_B.vy, 0.2);
  EXPECT_EQ(seen.joints.at("a"), 1.0);
  EXPECT_EQ(seen.joint_velocities.at("a"), 0.5);
}

TEST_F(SensesTest, SeveralNodesMayTellOfJoints) {
  senses_.OnLocalisation(1.0, {});
  TellBase(1.0);
  senses_.OnJoints(1.0, {{{"b", 2.0}}, {}});
  EXPECT_THAT(senses_.Look(1.0).joints, SizeIs(2));
}

TEST_F(SensesTest, AScanIsPutWhereTheRobotWasWhenItWasTaken) {
  senses_.OnLocalisation(1.0, {3.0, 2.0, 0.0});
  TellBase(1.0);
  senses_.OnScan(1.0, Beam(1.02));
  TellBase(1.1, {0.1, 0.0, 0.0});
  const auto seen = senses_.Look(1.1);
  ASSERT_THAT(seen.obstacles_M, SizeIs(1));
  EXPECT_TRUE(hires::geometry::Contains(seen.obstacles_M[0], {4.02, 2.0}));
}

/// The PR2 of the package, which has a head and hands.
class SensesOfObjectsTest : public ::testing::Test {
 protected:
  SensesOfObjectsTest() {
    senses_.OnLocalisation(1.0, {3.0, 2.0, 0.0});
    Tell(1.0);
  }
  void Tell(double stamp) {
    senses_.OnOdometry(stamp, {});
    senses_.OnJoints(stamp, {robot_->profile.joints, {}});
  }
  static hires::world::WorldState MillAt(double x, const std::string& link = "") {
    hires::world::WorldState state;
    state.objects.push_back({"Mill1", "mill", hires::geometry::Lift({x, 1.0, 0.0}), {}, link});
    return state;
  }

  std::shared_ptr<const hires::robot::Robot> robot_ = std::make_shared<const hires::robot::Robot>(
      hires::robot::LoadRobot(std::string(HIRES_SOURCE_DIR) + "/config/robots/pr2.yaml"));
  hires::sensing::ScanObstacles obstacles_{RoomMap(), robot_->profile.footprint, {}};
  Senses senses_{robot_, std::make_shared<const hires::perception::Surroundings>(Room()),
                 obstacles_, Pr2Names(), 0.3};
};

/// A PR2's joint_states has 45 joints: those of its finger tips follow others.
TEST_F(SensesOfObjectsTest, JointsThatFollowOthersOrThatNobodyKnowsAreLeftOut) {
  JointReading reading{robot_->profile.joints, {}};
  reading.positions["l_gripper_r_finger_tip_joint"] = 0.1;
  reading.velocities["l_gripper_r_finger_tip_joint"] = 0.1;
  reading.positions["gadget_joint"] = 1.0;
  reading.positions["fl_caster_rotation_joint"] = 0.5;
  senses_.OnOdometry(1.1, {});
  senses_.OnJoints(1.1, reading);
  const auto seen = senses_.Look(1.1);
  EXPECT_EQ(seen.joints.count("l_gripper_r_finger_tip_joint"), 0u);
  EXPECT_EQ(seen.joint_velocities.count("l_gripper_r_finger_tip_joint"), 0u);
  EXPECT_EQ(seen.joints.count("gadget_joint"), 0u);
  EXPECT_EQ(seen.joints.at("fl_caster_rotation_joint"), 0.5);
}

TEST_F(SensesOfObjectsTest, WhatIsSeenStandsWhereTheCameraWasThen) {
  hires::geometry::Pose3 X_CO;
  X_CO.translation = {1.0, 0.0, 0.0};
  senses_.OnDetections(1.0, {{"Mill1", "mill", X_CO, 1.0}});
  const auto seen = senses_.Look(1.0);
  ASSERT_THAT(seen.objects, SizeIs(1));
  EXPECT_EQ(seen.objects[0].name, "mill1");
  EXPECT_EQ(seen.objects[0].time, 1.0);
  const auto view = hires::perception::ViewOf(*robot_, {3.0, 2.0, 0.0}, robot_->profile.joints);
  EXPECT_NEAR((seen.objects[0].X_MO.translation - view.X_MC * X_CO.translation).norm(), 0.0, 1e-9);
}

TEST_F(SensesOfObjectsTest, ALookAheadOfTheOtherSensorsWaitsForThem) {
  senses_.OnDetections(1.01, {{"Mill1", "mill", {}, 1.0}});
  EXPECT_THAT(senses_.Look(1.0).objects, IsEmpty());
  Tell(1.01);
  EXPECT_THAT(senses_.Look(1.01).objects, SizeIs(1));
}

TEST_F(SensesOfObjectsTest, HearsayCountsUntilItIsTakenBackOrSeenOtherwise) {
  senses_.OnKnownObjects(MillAt(5.0));
  EXPECT_NEAR(senses_.Look(1.0).objects.at(0).X_MO.translation.x(), 5.0, 1e-9);
  senses_.OnKnownObjects({});
  EXPECT_THAT(senses_.Look(1.0).objects, IsEmpty());
  hires::geometry::Pose3 X_CO;
  X_CO.translation = {1.0, 0.0, 0.0};
  senses_.OnDetections(1.0, {{"mill1", "mill", X_CO, 1.0}});
  senses_.OnKnownObjects(MillAt(5.0));
  EXPECT_LT(senses_.Look(1.0).objects.at(0).X_MO.translation.x(), 4.5);
}

TEST_F(SensesOfObjectsTest, BadWordsAreLeftOut) {
  senses_.OnKnownObjects(MillAt(5.0, "tail_link"));
  EXPECT_THAT(senses_.Look(1.0).objects, IsEmpty());
  senses_.OnDetections(1.0, {{"vase1", "vase", {}, 1.0}});
  EXPECT_THAT(senses_.Look(1.0).objects, IsEmpty());
}

}  // namespace
}  // namespace hires_ros
