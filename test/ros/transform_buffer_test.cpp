#include "hires/ros/transform_buffer.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "hires/ros/robot_messages.h"
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
