#include "hires/perception/point_cloud.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace hires::perception::point_cloud_test
