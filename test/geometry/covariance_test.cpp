#include "hires/geometry/covariance.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hires::geometry::covariance_test {
namespace {

TEST(LargestSdTest, TheWorstDirectionCounts) {
  EXPECT_NEAR(LargestSd(0.04, 0.0, 0.01), 0.2, 1e-12);
  EXPECT_NEAR(LargestSd(0.02, 0.02, 0.02), 0.2, 1e-12);  // 0.04 along the diagonal, 0 across
  EXPECT_EQ(LargestSd(0.0, 0.0, 0.0), 0.0);
  EXPECT_TRUE(std::isnan(LargestSd(-1.0, 0.0, -1.0)));
  EXPECT_TRUE(std::isnan(LargestSd(NAN, 0.0, 1.0)));
}

}  // namespace
}  // namespace hires::geometry::covariance_test
