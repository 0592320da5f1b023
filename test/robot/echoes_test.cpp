#include "hires/robot/echoes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace hires::robot::echoes_test {
namespace {

const geometry::Polygon kBody{{0.3, -0.3}, {0.3, 0.3}, {-0.3, 0.3}, {-0.3, -0.3}};

/// Four beams: ahead, left, behind, right of a laser that sits 0.2 m ahead of the base's origin.
PlacedScan ScanOf(const std::vector<float>& ranges) {
  PlacedScan scan;
  scan.reading = {0.0, M_PI / 2.0, 0.05, ranges, 10.0};
  scan.X_BL = {0.2, 0.0, 0.0};
  return scan;
}

TEST(EchoesTest, LieInTheBase) {
  const auto echoes = EchoesOf(ScanOf({1.0f, 2.0f, 3.0f, 4.0f}), kBody);
  ASSERT_EQ(echoes.size(), 4u);
  EXPECT_NEAR((echoes[0] - Eigen::Vector2d(1.2, 0.0)).norm(), 0.0, 1e-6);
  EXPECT_NEAR((echoes[1] - Eigen::Vector2d(0.2, 2.0)).norm(), 0.0, 1e-6);
  EXPECT_NEAR((echoes[2] - Eigen::Vector2d(-2.8, 0.0)).norm(), 0.0, 1e-6);
  EXPECT_NEAR((echoes[3] - Eigen::Vector2d(0.2, -4.0)).norm(), 0.0, 1e-6);
}

TEST(EchoesTest, TheRobotItselfAndWhatIsNoMeasurementAreNone) {
  const float nan = std::nanf(""), infinite = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(EchoesOf(ScanOf({nan, infinite, -infinite, 10.0f}), kBody).empty());
  EXPECT_TRUE(EchoesOf(ScanOf({0.0f, -1.0f, 0.04f, 12.0f}), kBody).empty());
  EXPECT_EQ(EchoesOf(ScanOf({0.09f, 0.2f, 0.4f, 0.4f}), kBody).size(), 1u)
      << "only the last lies outside of the body";
}

TEST(EchoesTest, WhereNobodySaysHowFarItSeesAllIsAnEcho) {
  PlacedScan scan = ScanOf({50.0f, 1.0f, 1.0f, 1.0f});
  scan.reading.range_max = 0.0;
  EXPECT_EQ(EchoesOf(scan, kBody).size(), 4u);
}

}  // namespace
}  // namespace hires::robot::echoes_test
