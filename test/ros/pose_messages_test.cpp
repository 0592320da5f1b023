#include "hires/ros/values/pose_messages.h"

#include <gmock/gmock.h>

#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "hires/base/error.h"

namespace hires_ros::pose_messages_test {
namespace {

using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

UncertainPose Somewhere() {
  UncertainPose pose{{1.5, -2.0, 2.5}, {}};
  pose.covariance << 0.1, 0.01, 0.02, 0.01, 0.2, 0.03, 0.02, 0.03, 0.3;
  return pose;
}

TEST(PoseMessagesTest, PoseComesBackWithItsCovariance) {
  std_msgs::Header header;
  header.frame_id = "map";
  const auto msg = ToMsg(Somewhere(), header);
  EXPECT_EQ(msg.header.frame_id, "map");
  EXPECT_EQ(msg.pose.covariance[5], 0.02);   // x, yaw
  EXPECT_EQ(msg.pose.covariance[14], 0.0);   // z, z
  EXPECT_EQ(msg.pose.covariance[31], 0.03);  // yaw, y
  const UncertainPose back = FromMsg(msg.pose);
  EXPECT_EQ(back.X_AB.position(), Somewhere().X_AB.position());
  EXPECT_NEAR(back.X_AB.yaw, 2.5, 1e-12);
  EXPECT_EQ(back.covariance, Somewhere().covariance);
}

TEST(PoseMessagesTest, WhatIsNoPoseIsRefusedByItsField) {
  using Msg = geometry_msgs::PoseWithCovariance;
  const std::vector<std::pair<std::string, std::function<void(Msg*)>>> faults{
      {"pose.pose.position", [](Msg* msg) { msg->pose.position.y = kNan; }},
      {"pose.pose.orientation has length nan", [](Msg* msg) { msg->pose.orientation.x = kNan; }},
      {"pose.pose.orientation has length 0", [](Msg* msg) { msg->pose.orientation = {}; }},
      {"pose.covariance", [](Msg* msg) { msg->covariance[35] = kNan; }}};
  for (const auto& [wanted, spoil] : faults) {
    Msg msg = ToMsg(Somewhere(), {}).pose;
    spoil(&msg);
    try {
      FromMsg(msg);
      ADD_FAILURE() << wanted;
    } catch (const hires::base::ConfigError& error) {
      EXPECT_THAT(error.what(), HasSubstr(wanted));
    }
  }
}

}  // namespace
}  // namespace hires_ros::pose_messages_test
