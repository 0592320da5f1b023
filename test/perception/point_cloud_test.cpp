#include "hires/perception/point_cloud.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace hires::perception::point_cloud_test {
namespace {

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

TEST(TakeOnlyAheadTest, WhatNoCameraMeasuresCountsAsNotMeasured) {
  PointCloud cloud{4, 1, {{0, 0, 0}, {0.1F, 0.2F, 1.0F}, {kNothing, 0, 0}, {0, 0, 0}}};
  EXPECT_EQ(TakeOnlyAhead(&cloud), "") << "zeros say that nothing was measured";
  for (const int i : {0, 2, 3}) EXPECT_FALSE(IsMeasured(cloud.points[i])) << i;
  EXPECT_EQ(cloud.points[1], Eigen::Vector3f(0.1F, 0.2F, 1.0F));
}

TEST(TakeOnlyAheadTest, HugeNumbersOfEitherSignSayThatNothingWasMeasured) {
  for (const float huge : {1e30F, -1e30F, std::numeric_limits<float>::max(), 2e4F, -2e4F}) {
    PointCloud cloud{10, 1, std::vector<Eigen::Vector3f>(10, {0.5F, 0.0F, 1.0F})};
    for (int i = 0; i < 7; ++i) cloud.points[i].setConstant(huge);
    cloud.points[7].x() = huge;
    EXPECT_EQ(TakeOnlyAhead(&cloud), "") << huge;
    for (int i = 0; i < 8; ++i) EXPECT_FALSE(IsMeasured(cloud.points[i])) << huge << ", " << i;
    EXPECT_TRUE(IsMeasured(cloud.points[9]));
  }
}

TEST(TakeOnlyAheadTest, FewPointsBehindAreDroppedAndManySayThatTheFrameIsWrong) {
  PointCloud cloud{10, 1, std::vector<Eigen::Vector3f>(10, {0.5F, 0.0F, 1.0F})};
  cloud.points[3] = {0.5F, 0.0F, -1.0F};
  EXPECT_EQ(TakeOnlyAhead(&cloud), "");
  EXPECT_FALSE(IsMeasured(cloud.points[3])) << "else its mirror image were seen";
  cloud.points[3] = cloud.points[4] = {1.0F, 0.5F, -0.5F};
  EXPECT_EQ(TakeOnlyAhead(&cloud),
            "2 of 10 points lie behind the camera; wanted an optical frame (x right, y down, z "
            "forward)");
}

/// A table 0.9 m ahead of a camera that looks down, in the frame of a base: z up from the floor.
TEST(TakeOnlyAheadTest, FramesWithZUpAreNone) {
  for (const float ahead : {0.0F, 0.5F, 1.0F}) {
    PointCloud cloud;
    for (int i = 0; i < 20; ++i) {
      for (int k = 0; k < 20; ++k) {
        const float x = ahead + 0.1F * static_cast<float>(i);
        const float y = -1.0F + 0.1F * static_cast<float>(k);
        cloud.points.emplace_back(x, y, i > 8 && i < 15 ? 0.72F : 0.02F);
      }
    }
    cloud.width = static_cast<int>(cloud.points.size());
    EXPECT_THAT(TakeOnlyAhead(&cloud),
                testing::HasSubstr("more than 65 degrees off the z axis, along which the camera "
                                   "looks; wanted an optical frame (x right, y down, z forward)"))
        << ahead;
  }
}

TEST(TakeOnlyAheadTest, AWideCameraAndAFewPointsAsideAreNoOtherFrame) {
  PointCloud cloud;
  for (int i = 0; i < 1000; ++i) {
    const float angle = 0.00111F * static_cast<float>(i);  // up to 63.5 degrees
    const float sign = i % 2 == 0 ? 1.0F : -1.0F;
    cloud.points.emplace_back(sign * std::tan(angle), 0.0F, 1.0F);
  }
  cloud.width = 1000;
  for (int i = 0; i < 20; ++i) cloud.points[50 * i] = {0.0F, 3.0F, 1.0F};
  EXPECT_EQ(TakeOnlyAhead(&cloud), "");
  EXPECT_TRUE(IsMeasured(cloud.points[50])) << "what is ahead stays";
  cloud.points[1] = {0.0F, -3.0F, 1.0F};
  EXPECT_THAT(TakeOnlyAhead(&cloud), testing::HasSubstr("21 of 1000 points lie more than 65"));
}

}  // namespace
}  // namespace hires::perception::point_cloud_test
