#include "hires/sensing/observation_maker.h"

#include <gmock/gmock.h>

#include <cmath>

#include "hires/geometry/angles.h"
#include "support/fake_frame_tree.h"
#include "support/scenes.h"

namespace hires::sensing::observation_maker_test {
namespace {

using geometry::Lift;
using geometry::Pose2;
using test_support::FakeFrameTree;
using test_support::Room;
using test_support::TrayRobot;
using testing::IsEmpty;
using testing::SizeIs;

std::shared_ptr<const navigation::Costmap> RoomMap() {
  return std::make_shared<const navigation::Costmap>(world::SliceWorld(Room(), 0.1, 0.9), 0.25,
                                                     navigation::CostmapParams{});
}

/// A single beam, straight ahead.
robot::ScanReading Beam(double range) { return {0.0, 0.01, 0.08, {static_cast<float>(range)}}; }

class ObservationMakerTest : public testing::Test {
 protected:
  void Sense(double time, const Pose2& X_MB) {
    tree_->Tell("map", "odom", time, {});
    state_.OnTransforms(time);
    state_.OnOdometry(time, "odom", "", {X_MB, {0.1, 0.2, 0.3}});
    state_.OnJoints(time, {{{"a", 1.0}}, {{"a", 0.5}}});
  }
  robot::Observation Observe(double time) { return maker_.Observe(*state_.At(time)); }

  std::shared_ptr<FakeFrameTree> tree_ = std::make_shared<FakeFrameTree>();
  std::shared_ptr<const robot::Robot> robot_ = std::make_shared<const robot::Robot>(TrayRobot());
  RobotStateEstimator state_{robot_, {"map", "odom", "base"}, {}, {}, tree_};
  ObservationMaker maker_{
      &state_, {RoomMap(), robot_->profile.footprint, {}}, robot_->profile.footprint};
};

TEST_F(ObservationMakerTest, SkillsSeeTheStateOfTheMoment) {
  Sense(1.0, {3.0, 2.0, 0.5});
  const auto seen = Observe(1.0);
  EXPECT_EQ(seen.time, 1.0);
  EXPECT_EQ(seen.X_MB.yaw, 0.5);
  EXPECT_EQ(seen.V_B.vy, 0.2);
  EXPECT_EQ(seen.joints.at("a"), 1.0);
  EXPECT_EQ(seen.joint_velocities.at("a"), 0.5);
}

TEST_F(ObservationMakerTest, AScanIsPutWhereTheRobotWasWhenItWasTaken) {
  Sense(1.0, {3.0, 2.0, 0.0});
  EXPECT_TRUE(maker_.OnScan(1.0, "base", Beam(1.02)).is_taken());
  Sense(1.1, {3.1, 2.0, 0.0});
  const auto seen = Observe(1.1);
  ASSERT_THAT(seen.obstacles_M, SizeIs(1));
  EXPECT_TRUE(geometry::Contains(seen.obstacles_M[0], {4.02, 2.0}));
}

TEST_F(ObservationMakerTest, SkillsSeeTheLastScanAndWhereItWasTaken) {
  Sense(1.0, {3.0, 2.0, 0.0});
  EXPECT_FALSE(Observe(1.0).scan) << "none has come";
  maker_.OnScan(1.0, "base", Beam(1.02));
  Sense(1.1, {3.1, 2.0, 0.0});
  const auto seen = Observe(1.1);
  ASSERT_TRUE(seen.scan);
  EXPECT_NEAR(seen.scan->X_OB.x, 3.0, 1e-12) << "by the odometry of its time";
  EXPECT_NEAR(seen.X_OB.x, 3.1, 1e-12);
  EXPECT_FLOAT_EQ(seen.scan->reading.ranges[0], 1.02f);
  EXPECT_EQ(Observe(1.1).scan, seen.scan) << "the same until another comes";
}

TEST_F(ObservationMakerTest, AScanOfLaterDoesNotDriveOutTheOneOfNow) {
  Sense(1.0, {3.0, 2.0, 0.0});
  maker_.OnScan(1.0, "base", Beam(1.02));
  maker_.OnScan(1.05, "base", Beam(5.0));  // nothing within reach
  EXPECT_THAT(Observe(1.0).obstacles_M, SizeIs(1));
  Sense(1.1, {3.0, 2.0, 0.0});
  EXPECT_THAT(Observe(1.1).obstacles_M, IsEmpty());
}

TEST_F(ObservationMakerTest, ALaserThatHangsOnTheTreeIsFoundThere) {
  tree_->TellFixed("base", "laser", Lift({0.5, 0.0, 0.0}));
  Sense(1.0, {3.0, 2.0, 0.0});
  maker_.OnScan(1.0, "laser", Beam(0.52));
  const auto seen = Observe(1.0);
  ASSERT_THAT(seen.obstacles_M, SizeIs(1));
  EXPECT_TRUE(geometry::Contains(seen.obstacles_M[0], {4.02, 2.0}));
}

TEST_F(ObservationMakerTest, AScanOfALaserThatHangsUpsideDownIsTurnedOver) {
  tree_->TellFixed("base", "hanging",
                   {{0.5, 0.0, 0.25}, geometry::RotationFromRpy(geometry::kPi, 0.0, 0.0)});
  Sense(1.0, {3.0, 2.0, 0.0});
  // To its left, which is the robot's right.
  maker_.OnScan(1.0, "hanging", {geometry::kPi / 2.0, 0.01, 0.08, {1.02f}});
  const auto seen = Observe(1.0);
  ASSERT_THAT(seen.obstacles_M, SizeIs(1));
  EXPECT_TRUE(geometry::Contains(seen.obstacles_M[0], {3.5, 0.98}));
  const double angle = seen.scan->reading.angle_min;
  const Eigen::Vector2d echo_B =
      seen.scan->X_BL * Eigen::Vector2d(1.02 * std::cos(angle), 1.02 * std::sin(angle));
  EXPECT_NEAR(echo_B.x(), 0.5, 1e-9);
  EXPECT_NEAR(echo_B.y(), -1.02, 1e-9);
}

TEST_F(ObservationMakerTest, AScanOfATiltedLaserIsDroppedByName) {
  tree_->TellFixed("base", "nodding", {{0.5, 0.0, 0.25}, geometry::RotationFromRpy(0.0, 0.3, 0.0)});
  Sense(1.0, {3.0, 2.0, 0.0});
  maker_.OnScan(1.0, "nodding", Beam(1.02));
  const auto seen = Observe(1.0);
  EXPECT_THAT(seen.obstacles_M, IsEmpty());
  EXPECT_FALSE(seen.scan);
  EXPECT_EQ(maker_.scan_receipt().what, Reception::kTilted);
  EXPECT_TRUE(maker_.scan_receipt().is_bad());
  EXPECT_THAT(ToString(maker_.scan_receipt()),
              testing::HasSubstr("'nodding' is tilted by more than 0.1 rad"));
}

TEST_F(ObservationMakerTest, AScanOfAFrameNobodyKnowsIsDroppedByName) {
  Sense(1.0, {3.0, 2.0, 0.0});
  maker_.OnScan(1.0, "nose", Beam(1.02));
  EXPECT_THAT(Observe(1.0).obstacles_M, IsEmpty());
  EXPECT_EQ(maker_.scan_receipt().what, Reception::kUnknownFrame);
  EXPECT_EQ(maker_.scan_receipt().subject, "nose");
  Sense(1.1, {3.0, 2.0, 0.0});
  maker_.OnScan(1.1, "base", Beam(1.02));
  EXPECT_THAT(Observe(1.1).obstacles_M, SizeIs(1));
  EXPECT_TRUE(maker_.scan_receipt().is_taken());
}

TEST_F(ObservationMakerTest, AScanWithoutATimeIsRefused) {
  EXPECT_EQ(maker_.OnScan(0.0, "base", Beam(1.0)).what, Reception::kNoStamp);
}

}  // namespace
}  // namespace hires::sensing::observation_maker_test
