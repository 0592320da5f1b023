#include "hires/ros/transforms/transform_listener.h"

#include <gmock/gmock.h>

#include <string>
#include <tuple>
#include <vector>

#include "hires/ros/robot/robot_messages.h"

namespace hires_ros::transform_listener_test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// base in odom, each second from 10 to 12 s.
class PlaceAtTest : public testing::Test {
 protected:
  PlaceAtTest() {
    for (const double time : {10.0, 11.0, 12.0}) {
      tf2_msgs::TFMessage msg;
      msg.transforms.push_back(
          MakeTransform("odom", "base", hires::geometry::Lift({time, 0.0, 0.0}), ros::Time(time)));
      tree_.Take(msg, false);
    }
  }
  TransformBuffer tree_;
};

TEST_F(PlaceAtTest, FrameThatIsKnownThenIsSaid) {
  const Placement placed = PlaceAt(tree_, "odom", "base", 10.5);
  ASSERT_TRUE(placed.X_PC);
  EXPECT_NEAR(placed.X_PC->translation.x(), 10.5, 1e-9);
  EXPECT_THAT(placed.waits_for + placed.why_never, IsEmpty());
}

TEST_F(PlaceAtTest, WhatMayStillComeIsWaitedFor) {
  for (const auto& [child, time, wanted] :
       std::vector<std::tuple<std::string, double, std::string>>{
           {"base", 12.5, "newest is of 12.000 s"}, {"arm", 11.0, "does not know frame 'arm'"}}) {
    const Placement placed = PlaceAt(tree_, "odom", child, time);
    EXPECT_FALSE(placed.X_PC);
    EXPECT_THAT(placed.waits_for, HasSubstr(wanted));
    EXPECT_THAT(placed.why_never, IsEmpty());
  }
}

TEST_F(PlaceAtTest, WhatIsForgottenWillNotCome) {
  const Placement placed = PlaceAt(tree_, "odom", "base", 9.0);
  EXPECT_FALSE(placed.X_PC);
  EXPECT_THAT(placed.why_never, HasSubstr("older than what is kept of tf"));
  EXPECT_THAT(placed.waits_for, IsEmpty());
}

}  // namespace
}  // namespace hires_ros::transform_listener_test
