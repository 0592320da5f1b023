#include "loop/frame_record.h"

#include <gmock/gmock.h>

namespace hires::loop::frame_record_test {
namespace {

using sensing::FrameStatus;

geometry::Pose3 At(double x, double yaw) { return geometry::Lift({x, 0.0, yaw}); }

class FrameRecordTest : public testing::Test {
 protected:
  FrameRecordTest() {
    frames_.Tell("map", "odom", 1.0, At(0.0, 0.0));
    frames_.Tell("map", "odom", 2.0, At(1.0, 0.4));
  }
  FrameRecord frames_{3.0};
};

TEST_F(FrameRecordTest, BetweenTwoMomentsItIsInterpolated) {
  const auto found = frames_.Find("map", "odom", 1.5);
  ASSERT_EQ(found.status, FrameStatus::kFound);
  EXPECT_NEAR(found.X_PC.translation.x(), 0.5, 1e-12);
  EXPECT_NEAR(geometry::Flatten(found.X_PC).yaw, 0.2, 1e-12);
  EXPECT_EQ(frames_.Find("map", "odom", 2.0).X_PC.translation.x(), 1.0) << "to the bit";
}

TEST_F(FrameRecordTest, OutsideOfThemAndBetweenOthersNothingIsKnown) {
  EXPECT_EQ(frames_.Find("map", "odom", 2.1).status, FrameStatus::kNotThen);
  EXPECT_EQ(frames_.Find("map", "odom", 0.9).status, FrameStatus::kNotThen);
  EXPECT_EQ(frames_.Find("odom", "map", 1.5).status, FrameStatus::kNotConnected);
  EXPECT_EQ(frames_.NewestOf("map", "odom"), 2.0);
  EXPECT_EQ(frames_.NewestOf("map", "base"), std::nullopt);
}

TEST_F(FrameRecordTest, WhatIsOldIsForgotten) {
  frames_.Tell("map", "odom", 4.5, At(2.0, 0.0));
  EXPECT_EQ(frames_.Find("map", "odom", 1.2).status, FrameStatus::kNotThen);
  EXPECT_EQ(frames_.Find("map", "odom", 3.0).status, FrameStatus::kFound);
  frames_.ForgetMoving();
  EXPECT_EQ(frames_.NewestOf("map", "odom"), std::nullopt);
}

}  // namespace
}  // namespace hires::loop::frame_record_test
