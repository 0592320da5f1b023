#include "hires/sensing/ground_watch.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "hires/base/error.h"
#include "hires/base/param_reader.h"
#include "hires/perception/camera_view.h"
#include "support/fake_frame_tree.h"
#include "support/scenes.h"
#include "support/sight_scenes.h"
#include "support/tilt_sweep.h"

namespace hires::sensing::ground_watch_test {
namespace {

using geometry::Pose2;
using geometry::Pose3;
using test_support::At;
using testing::IsEmpty;
using testing::Not;

const Pose3 kLaser = At(0.1, 0.0, 1.3);  // in the base

/// A robot with a laser over its torso, in a room with a box that the map does not have.
class GroundWatchTest : public testing::Test {
 protected:
  explicit GroundWatchTest(const std::string& eye = "")
      : watch_(&state_, robot_,
               std::make_shared<const navigation::Costmap>(
                   world::SliceWorld(test_support::Room(), 0.1, 0.9), 0.25,
                   navigation::CostmapParams{}),
               Seen(eye)) {
    tree_->TellFixed("base", "laser", kLaser);
  }
  static GroundWatchParams Seen(const std::string& eye) {
    GroundWatchParams params;
    params.eye = eye;
    return params;
  }
  void Stand(double time, const Pose2& X_MB) {
    tree_->Tell("map", "odom", time, {});
    state_.OnTransforms(time);
    state_.OnOdometry(time, "odom", "", {X_MB, {}});
    state_.OnJoints(time, {{{"a", 1.0}}, {{"a", 0.5}}});
  }
  /// A sweep in the laser's frame, in which the robot sees itself.
  perception::PointCloud Sweep(const Pose2& X_MB) {
    world::World room = test_support::Room();
    room.statics.push_back(test_support::Block("box", {0.3, 0.3, 0.3}, {4.5, 2.0, 0.15}));
    const perception::LineOfSight sight(std::make_shared<perception::Surroundings>(room), {},
                                        perception::ShapesOf(*robot_, X_MB, {}));
    base::Rng rng(2);
    return test_support::TiltSweep{320, 80}.Measure(sight, geometry::Lift(X_MB) * kLaser, &rng);
  }
  std::vector<geometry::Polygon> Obstacles(double time) {
    return watch_.Obstacles(*state_.At(time));
  }
  static void ExpectTheBoxAndNothingElse(const std::vector<geometry::Polygon>& squares) {
    EXPECT_THAT(squares, Not(IsEmpty()));
    const geometry::Polygon box{{4.35, 1.85}, {4.65, 1.85}, {4.65, 2.15}, {4.35, 2.15}};
    for (const geometry::Polygon& square : squares) {
      EXPECT_LT(geometry::Distance(square, box), 0.02) << square[0].transpose();
    }
  }

  std::shared_ptr<test_support::FakeFrameTree> tree_ =
      std::make_shared<test_support::FakeFrameTree>();
  /// Its mast stands out of its footprint, before the laser.
  std::shared_ptr<const robot::Robot> robot_ = [] {
    robot::Robot robot = test_support::TrayRobot();
    robot.model.links[0].collisions.push_back(
        test_support::Shape("arm", geometry::Box{{0.1, 0.1, 0.1}}, {0.7, 0.3, 0.8}));
    return std::make_shared<const robot::Robot>(robot);
  }();
  RobotStateEstimator state_{robot_, {"map", "odom", "base"}, {}, {}, tree_};
  GroundWatch watch_;
};

TEST_F(GroundWatchTest, WhatStandsOnTheFloorIsSeenWithoutTheRobotsOwnArm) {
  Stand(1.0, {3.0, 2.0, 0.0});
  EXPECT_TRUE(watch_.OnCloud(1.0, "laser", Sweep({3.0, 2.0, 0.0})).is_taken());
  ExpectTheBoxAndNothingElse(Obstacles(1.0));
  EXPECT_FALSE(watch_.receipt().is_bad());
}

TEST_F(GroundWatchTest, ACloudIsPutWhereTheRobotWasWhenItWasTaken) {
  Stand(1.0, {3.0, 2.0, 0.0});
  watch_.OnCloud(1.0, "laser", Sweep({3.0, 2.0, 0.0}));
  Stand(1.1, {3.1, 2.0, 0.1});
  ExpectTheBoxAndNothingElse(Obstacles(1.1));
}

// A sweep takes 1.8 s, in which the robot moves its arms, or drives on.
TEST_F(GroundWatchTest, WhatHangsWhereTheRobotWasDuringTheSweepIsItsOwn) {
  const Pose2 X_MB{3.0, 2.0, 0.0};
  const auto sweep = [&] {
    perception::PointCloud cloud = Sweep(X_MB);
    for (int i = 0; i < 20; ++i) {  // of the mast, 0.3 m to the right
      const Eigen::Vector3d p_B(0.7, -0.04 + 0.004 * i, 0.8);
      cloud.points.push_back((kLaser.Inverse() * p_B).cast<float>());
    }
    cloud.width = static_cast<int>(cloud.points.size());
    cloud.height = 1;
    return cloud;
  };
  Stand(1.0, X_MB);
  watch_.OnCloud(1.0, "laser", sweep());
  const auto still = Obstacles(1.0);
  EXPECT_TRUE(std::any_of(still.begin(), still.end(), [](const auto& square) {
    return geometry::Contains(square, {3.71, 2.01});
  })) << "where the robot never was, something hangs there";
  for (int i = 1; i <= 20; ++i) Stand(1.0 + 0.1 * i, {3.0, 2.0 - 0.3 * (20 - i) / 20.0, 0.0});
  watch_.OnCloud(3.0, "laser", sweep());
  ExpectTheBoxAndNothingElse(Obstacles(3.0));
}

TEST_F(GroundWatchTest, WhatAHandHoldsIsNoObstacle) {
  const Pose2 X_MB{3.0, 2.0, 0.0};
  perception::PointCloud cloud = Sweep(X_MB);
  for (int i = 0; i < 20; ++i) {  // a tall thing in the hand, far before the base
    const Eigen::Vector3d p_B(0.82, -0.18, 0.7 + 0.01 * i);
    cloud.points.push_back((kLaser.Inverse() * p_B).cast<float>());
  }
  cloud.width = static_cast<int>(cloud.points.size());
  cloud.height = 1;
  Stand(1.0, X_MB);
  watch_.OnCloud(1.0, "laser", cloud);
  const auto squares = Obstacles(1.0);
  EXPECT_TRUE(std::any_of(squares.begin(), squares.end(), [](const auto& square) {
    return geometry::Contains(square, {3.82, 1.82});
  })) << "no hand is there";

  robot::Robot robot = *robot_;
  robot.profile.upper_body.emplace();
  robot::Link hand;
  hand.name = robot.profile.upper_body->arms["rightarm1"].tool_link = "hand";
  hand.joint = robot::Joint();
  hand.joint->name = "wrist";
  hand.joint->parent = 0;
  hand.joint->X_PJ.translation = {0.8, -0.2, 0.8};
  robot.model.links.push_back(hand);
  GroundWatch with_hand(
      &state_, std::make_shared<const robot::Robot>(robot),
      std::make_shared<const navigation::Costmap>(world::SliceWorld(test_support::Room(), 0.1, 0.9),
                                                  0.25, navigation::CostmapParams{}),
      Seen(""));
  with_hand.OnCloud(1.0, "laser", cloud);
  ExpectTheBoxAndNothingElse(with_hand.Obstacles(*state_.At(1.0)));
}

class GroundWatchByEyeTest : public GroundWatchTest {
 protected:
  GroundWatchByEyeTest() : GroundWatchTest("laser") {}
};

TEST_F(GroundWatchByEyeTest, ACloudInAnotherFrameIsLookedAtFromTheEye) {
  Stand(1.0, {3.0, 2.0, 0.0});
  perception::PointCloud cloud = Sweep({3.0, 2.0, 0.0});
  for (Eigen::Vector3f& p : cloud.points) p += kLaser.translation.cast<float>();
  watch_.OnCloud(1.0, "base", std::move(cloud));
  ExpectTheBoxAndNothingElse(Obstacles(1.0));
}

TEST_F(GroundWatchTest, WhatWasSeenIsForgottenAfterAWhile) {
  Stand(1.0, {3.0, 2.0, 0.0});
  watch_.OnCloud(1.0, "laser", Sweep({3.0, 2.0, 0.0}));
  EXPECT_THAT(Obstacles(1.0), Not(IsEmpty()));
  for (double time = 1.05; time < 6.2; time += 0.05) Stand(time, {3.0, 2.0, 0.0});
  EXPECT_THAT(Obstacles(5.9), Not(IsEmpty()));
  EXPECT_THAT(Obstacles(6.1), IsEmpty());
}

TEST_F(GroundWatchTest, ACloudOfAFrameNobodyKnowsOrWithoutAStampIsDroppedByName) {
  Stand(1.0, {3.0, 2.0, 0.0});
  EXPECT_EQ(watch_.OnCloud(0.0, "laser", {}).what, Reception::kNoStamp);
  watch_.OnCloud(1.0, "submarine", Sweep({3.0, 2.0, 0.0}));
  EXPECT_THAT(Obstacles(1.0), IsEmpty());
  EXPECT_TRUE(watch_.receipt().is_bad());
  EXPECT_EQ(watch_.receipt().subject, "submarine");
}

TEST(GroundWatchParamsTest, TheShippedOnesAreTheDefaultsAndABadOneIsNamed) {
  auto in = base::ParamReader::FromFile(HIRES_SOURCE_DIR "/config/scene.yaml");
  EXPECT_TRUE(ReadGroundWatchParams(in.Sub("sensing").Sub("ground")) == GroundWatchParams());
  const auto bad = base::ParamReader::FromString(
      "enabled: true\ntolerance: 0.1\nrange: 2\ncell: 0.1\nmax_tilt: 3.0\n", "test.yaml");
  try {
    ReadGroundWatchParams(bad);
    FAIL() << "was taken";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("max_tilt"));
  }
}

}  // namespace
}  // namespace hires::sensing::ground_watch_test
