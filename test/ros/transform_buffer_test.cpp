#include "hires/ros/transforms/transform_buffer.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "hires/ros/robot/robot_messages.h"
#include "hires/sensing/robot_state_estimator.h"
#include "support/scenes.h"

namespace hires_ros::transform_buffer_test {
namespace {

using hires::geometry::Flatten;
using hires::geometry::Lift;
using hires::geometry::Pose2;
using hires::sensing::FrameStatus;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kForever = std::numeric_limits<double>::infinity();

class TransformBufferTest : public ::testing::Test {
 protected:
  TransformBuffer::News Tell(const std::string& parent, const std::string& child, double stamp,
                             const Pose2& X_PC, bool is_static = false) {
    tf2_msgs::TFMessage msg;
    msg.transforms.push_back(MakeTransform(parent, child, Lift(X_PC), ros::Time(stamp)));
    return buffer_.Take(msg, is_static);
  }
  void ExpectPose(const std::string& parent, const std::string& child, double time,
                  const Pose2& wanted) {
    const auto found = buffer_.Find(parent, child, time);
    ASSERT_TRUE(found.is_found()) << parent << " " << child;
    const Pose2 pose = Flatten(found.X_PC);
    EXPECT_NEAR(pose.x, wanted.x, 1e-9);
    EXPECT_NEAR(pose.y, wanted.y, 1e-9);
    EXPECT_NEAR(pose.yaw, wanted.yaw, 1e-9);
  }

  TransformBuffer buffer_;
};

TEST_F(TransformBufferTest, FollowsChainsInBothDirections) {
  Tell("/map", "/odom_combined", 10.0, {1.0, 0.0, M_PI / 2});
  Tell("odom_combined", "base_footprint", 10.0, {2.0, 0.0, 0.0});
  ExpectPose("map", "base_footprint", 10.0, {1.0, 2.0, M_PI / 2});
  ExpectPose("base_footprint", "map", 10.0, {-2.0, 1.0, -M_PI / 2});
}

TEST_F(TransformBufferTest, TellsTheNamesOfAllItsFrames) {
  EXPECT_THAT(buffer_.Names(), IsEmpty());
  Tell("/map", "/odom_combined", 10.0, {});
  Tell("base_link", "laser", 10.0, {}, true);
  EXPECT_THAT(buffer_.Names(),
              ::testing::UnorderedElementsAre("map", "odom_combined", "base_link", "laser"));
}

TEST_F(TransformBufferTest, InterpolatesAndKnowsNothingBeyond) {
  Tell("map", "odom", 10.0, {0.0, 0.0, 0.0});
  Tell("map", "odom", 10.2, {1.0, 0.0, 0.4});
  ExpectPose("map", "odom", 10.05, {0.25, 0.0, 0.1});
  EXPECT_EQ(buffer_.Find("map", "odom", 10.3).status, FrameStatus::kNotThen);
  EXPECT_EQ(buffer_.Find("map", "odom", 9.9).status, FrameStatus::kNotThen);
  EXPECT_EQ(buffer_.NewestOf("map", "odom"), 10.2);
}

TEST_F(TransformBufferTest, TellsUnknownFramesFromUnconnectedOnes) {
  Tell("map", "odom", 10.0, {});
  Tell("moon", "crater", 10.0, {});
  EXPECT_EQ(buffer_.Find("map", "nowhere", 10.0).status, FrameStatus::kUnknown);
  EXPECT_EQ(buffer_.Find("", "odom", 10.0).status, FrameStatus::kUnknown);
  EXPECT_EQ(buffer_.Find("map", "crater", 10.0).status, FrameStatus::kNotConnected);
  EXPECT_FALSE(buffer_.NewestOf("map", "crater"));
  EXPECT_FALSE(buffer_.NewestOf("map", "nowhere"));
}

/// Seconds since 1970 have no place for nanoseconds in a double.
TEST_F(TransformBufferTest, TheNewestMomentCanBeAskedForWhateverTheClock) {
  for (int i = 0; i < 100; ++i) {
    tf2_msgs::TFMessage msg;
    const ros::Time stamp(1764000000 + i, 123456789 + 7654321 * (i % 90));
    msg.transforms.push_back(MakeTransform("map", "odom", Lift({1.0 * i, 0.0, 0.0}), stamp));
    const auto news = buffer_.Take(msg, false);
    ASSERT_EQ(news.stamps.size(), 1u);
    ExpectPose("map", "odom", news.stamps[0], {1.0 * i, 0.0, 0.0});
  }
}

TEST_F(TransformBufferTest, WhatNeverMovesIsKnownForAllTime) {
  EXPECT_THAT(Tell("base", "camera", 3.0, {0.5, 0.0, 0.0}, true).stamps, ElementsAre(kForever));
  EXPECT_EQ(buffer_.NewestOf("base", "camera"), kForever);
  ExpectPose("base", "camera", 1e6, {0.5, 0.0, 0.0});
  ExpectPose("base", "camera", kForever, {0.5, 0.0, 0.0});
  Tell("odom", "base", 10.0, {1.0, 0.0, 0.0});
  EXPECT_EQ(buffer_.NewestOf("odom", "camera"), 10.0);
  buffer_.ForgetMoving();
  EXPECT_FALSE(buffer_.NewestOf("odom", "base"));
  ExpectPose("base", "camera", 1.0, {0.5, 0.0, 0.0});
}

TEST_F(TransformBufferTest, WhatMakesNoSenseIsLeftOutByName) {
  EXPECT_THAT(Tell("map", "odom", 1.0, {std::nan(""), 0.0, 0.0}).warnings,
              ElementsAre(HasSubstr("'map' -> 'odom': it is not finite")));
  tf2_msgs::TFMessage msg;
  msg.transforms.emplace_back();
  EXPECT_THAT(buffer_.Take(msg, false).warnings, ElementsAre(HasSubstr("is empty")));
  msg.transforms[0].header.frame_id = "map";
  msg.transforms[0].child_frame_id = "odom";
  EXPECT_THAT(buffer_.Take(msg, false).warnings, ElementsAre(HasSubstr("has length 0")));
  EXPECT_THAT(buffer_.Take(msg, false).stamps, IsEmpty());
}

/// map -> odom (1, 2, 0; yaw 90 deg) -> base (3, 0, 0) -> camera (0, 0, 1; roll 90 deg) -> mug (0,
/// 0, 2): the base is at (1, 5, 0) in the map, the camera above it; its z axis is -y of the base,
/// which is x of the map. So the mug is at (3, 5, 1), turned by Rz(90) Rx(90) = (0.5, 0.5, 0.5,
/// 0.5).
TEST_F(TransformBufferTest, FollowsAChainOfTurnsInSpace) {
  using hires::geometry::Pose3;
  using hires::geometry::RotationFromRpy;
  const auto tell = [&](const std::string& parent, const std::string& child, const Pose3& X_PC) {
    tf2_msgs::TFMessage msg;
    msg.transforms.push_back(MakeTransform(parent, child, X_PC, ros::Time(10.0)));
    buffer_.Take(msg, false);
  };
  tell("camera", "mug", {{0.0, 0.0, 2.0}, Eigen::Quaterniond::Identity()});
  tell("base", "camera", {{0.0, 0.0, 1.0}, RotationFromRpy(M_PI / 2, 0.0, 0.0)});
  tell("odom", "base", {{3.0, 0.0, 0.0}, Eigen::Quaterniond::Identity()});
  tell("map", "odom", {{1.0, 2.0, 0.0}, RotationFromRpy(0.0, 0.0, M_PI / 2)});
  const auto found = buffer_.Find("map", "mug", 10.0);
  ASSERT_TRUE(found.is_found());
  EXPECT_LT((found.X_PC.translation - Eigen::Vector3d(3.0, 5.0, 1.0)).norm(), 1e-12);
  EXPECT_LT(found.X_PC.rotation.angularDistance(Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5)), 1e-12);
  const auto back = buffer_.Find("mug", "map", 10.0);
  EXPECT_LT((back.X_PC.translation - Eigen::Vector3d(-5.0, -1.0, -3.0)).norm(), 1e-12);
  EXPECT_EQ(buffer_.WhyNot("map", "mug", 10.0), "");
}

TEST_F(TransformBufferTest, SaysWhatIsKnownAboveFramesThatAreNotConnected) {
  Tell("map", "odom", 10.0, {});
  Tell("odom", "base", 10.0, {});
  Tell("venue", "lab_map", 10.0, {});
  EXPECT_EQ(
      buffer_.WhyNot("lab_map", "base", 10.0),
      "tf does not connect 'base' with 'lab_map' (it knows base < odom < map; lab_map < venue)");
  EXPECT_EQ(buffer_.WhyNot("map", "nowhere", 10.0), "tf does not know frame 'nowhere'");
  EXPECT_EQ(buffer_.WhyNot("nowhere", "map", 10.0), "tf does not know frame 'nowhere'");
  EXPECT_EQ(buffer_.WhyNot("map", "base", 10.5),
            "tf knows where 'base' is in 'map', but not at 10.500 s; its newest is of 10.000 s");
}

TEST_F(TransformBufferTest, ACircleOfLinksIsNeitherFollowedNorTakenForAGap) {
  Tell("map", "odom", 10.0, {});
  Tell("a", "b", 10.0, {});
  Tell("b", "c", 10.0, {});
  Tell("c", "a", 10.0, {});
  EXPECT_EQ(buffer_.Find("map", "b", 10.0).status, FrameStatus::kInLoop);
  EXPECT_FALSE(buffer_.NewestOf("map", "b"));
  EXPECT_THAT(buffer_.WhyNot("map", "b", 10.0), HasSubstr("lead in a circle (b < a < c < b; map)"));
}

TEST_F(TransformBufferTest, AFrameThatTwoNodesHangElsewhereByTurnsIsDoubted) {
  EXPECT_THAT(Tell("odom", "base", 10.0, {}).doubts, IsEmpty());
  EXPECT_THAT(Tell("map", "base", 10.1, {}).doubts, IsEmpty()) << "hung elsewhere once";
  EXPECT_THAT(Tell("map", "base", 10.2, {}).doubts, IsEmpty());
  const auto news = Tell("/odom", "/base", 10.3, {});
  EXPECT_THAT(news.doubts,
              ElementsAre(HasSubstr("'base' hangs below 'map' and below 'odom' by turns")));
  EXPECT_THAT(news.stamps, ElementsAre(10.3)) << "tf takes it all the same";
}

TEST_F(TransformBufferTest, AfterAClockBeganAgainOlderStampsCount) {
  Tell("map", "odom", 100.0, {5.0, 0.0, 0.0});
  Tell("map", "odom", 1.0, {1.0, 0.0, 0.0});
  EXPECT_EQ(buffer_.Find("map", "odom", 1.0).status, FrameStatus::kNotThen)
      << "more than 10 s late";
  buffer_.ForgetMoving();
  Tell("map", "odom", 1.0, {1.0, 0.0, 0.0});
  Tell("map", "odom", 2.0, {2.0, 0.0, 0.0});
  ExpectPose("map", "odom", 1.5, {1.5, 0.0, 0.0});
  EXPECT_EQ(buffer_.Find("map", "odom", 100.0).status, FrameStatus::kNotThen);
  EXPECT_EQ(buffer_.NewestOf("map", "odom"), 2.0);
}

/// A camera on the ceiling says where the base is; wheels count in a frame that tf does not know.
TEST_F(TransformBufferTest, TheRobotsStateNeedsNoLinkFromMapToOdometry) {
  const auto tree = std::make_shared<TransformBuffer>();
  const auto robot = std::make_shared<const hires::robot::Robot>(hires::test_support::TrayRobot());
  hires::sensing::RobotStateEstimator state(robot, {"map", "odom", "base"}, {}, {}, tree);
  const auto tell = [&](const std::string& parent, const std::string& child, double stamp,
                        const Pose2& X_PC, bool is_static) {
    tf2_msgs::TFMessage msg;
    msg.transforms.push_back(MakeTransform(parent, child, Lift(X_PC), ros::Time(stamp)));
    for (const double moment : tree->Take(msg, is_static).stamps) state.OnTransforms(moment);
  };
  tell("map", "ceiling", 1.0, {4.0, 0.0, M_PI}, true);
  tell("marker", "base", 1.0, {-0.5, 0.0, 0.0}, true);
  for (int i = 0; i <= 20; ++i) {
    const double stamp = 100.0 + 0.05 * i;
    state.OnOdometry(stamp, "wheels", "", {{0.1 * i, 0.0, 0.0}, {}});
    state.OnJoints(stamp, {{{"a", 0.0}}, {}});
    // Seen from the ceiling, whose x points against the map's, the marker drives towards -x.
    if (i % 3 == 0) tell("ceiling", "marker", stamp, {3.0 - 0.1 * i, 1.0, M_PI}, false);
    ASSERT_EQ(state.CompleteUntil(), stamp) << i;
    EXPECT_NEAR(state.At(stamp)->X_WB.x, 0.5 + 0.1 * i, 1e-9);
    EXPECT_NEAR(state.At(stamp)->X_WB.y, -1.0, 1e-9);
  }
}

/// As on a PR2: amcl dates its transform ahead, and the map hangs on another frame.
TEST_F(TransformBufferTest, TheRobotsStateFollowsAChainThatIsDatedAhead) {
  const auto tree = std::make_shared<TransformBuffer>();
  const auto robot = std::make_shared<const hires::robot::Robot>(hires::test_support::TrayRobot());
  hires::sensing::RobotStateEstimator state(robot, {"lab", "odom_combined", "base"}, {}, {}, tree);
  const auto tell = [&](const std::string& parent, const std::string& child, double stamp,
                        const Pose2& X_PC, bool is_static) {
    tf2_msgs::TFMessage msg;
    msg.transforms.push_back(MakeTransform(parent, child, Lift(X_PC), ros::Time(stamp)));
    for (const double moment : tree->Take(msg, is_static).stamps) state.OnTransforms(moment);
  };
  tell("lab", "map", 1.0, {10.0, 0.0, 0.0}, true);
  for (int i = 0; i <= 20; ++i) {
    const double stamp = 100.0 + 0.05 * i;
    state.OnOdometry(stamp, "odom_combined", "", {{0.1 * i, 0.0, 0.0}, {}});
    state.OnJoints(stamp, {{{"a", 0.0}}, {}});
    tell("map", "odom_combined", stamp + 0.2, {0.0, 1.0, 0.0}, false);
    ASSERT_EQ(state.CompleteUntil(), stamp);
    EXPECT_NEAR(state.At(stamp)->X_WB.x, 10.0 + 0.1 * i, 1e-9);
    EXPECT_NEAR(state.At(stamp)->X_WB.y, 1.0, 1e-9);
  }
}

}  // namespace
}  // namespace hires_ros::transform_buffer_test
