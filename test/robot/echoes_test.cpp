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

/// 201 beams of 4 rad in all; each sees 2 m far.
PlacedScan WideScan(float range) {
  PlacedScan scan;
  scan.reading = {-2.0, 0.02, 0.05, std::vector<float>(201, range), 10.0};
  scan.X_BL = {0.2, 0.0, 0.0};
  return scan;
}

TEST(IsInViewTest, WhereTheLaserLooksAndMeasures) {
  const PlacedScan scan = WideScan(2.0f);
  const auto at = [](double angle, double range) {
    return Eigen::Vector2d(0.2 + range * std::cos(angle), range * std::sin(angle));
  };
  for (const double angle : {-2.0, -1.0, 0.0, 1.999}) EXPECT_TRUE(IsInView(scan, at(angle, 1.0)));
  EXPECT_TRUE(IsInView(scan, at(0.3, 5.0))) << "behind what it sees: what it shows is all it knows";
  for (const double angle : {-2.1, 2.1, 3.1}) EXPECT_FALSE(IsInView(scan, at(angle, 1.0)));
  EXPECT_FALSE(IsInView(scan, at(0.0, 0.04))) << "nearer than it measures";
  EXPECT_FALSE(IsInView(scan, at(0.0, 0.07))) << "or so by its noise";
  EXPECT_TRUE(IsInView(scan, at(0.0, 0.09)));
}

TEST(IsInViewTest, ABeamThatIsNoMeasurementShowsNothing) {
  const Eigen::Vector2d ahead(1.0, 0.0);
  for (const float none : {std::nanf(""), 0.0f, 0.04f, -1.0f})
    EXPECT_FALSE(IsInView(WideScan(none), ahead)) << none;
  for (const float nothing : {std::numeric_limits<float>::infinity(), 10.0f, 11.0f})
    EXPECT_TRUE(IsInView(WideScan(nothing), ahead)) << nothing;
  EXPECT_FALSE(IsInView({}, ahead));
}

TEST(IsInViewTest, ALaserMayHangUpsideDownOrSeeAllAround) {
  PlacedScan scan = WideScan(2.0f);
  scan.reading.angle_min = 2.0;
  scan.reading.angle_increment = -0.02;
  EXPECT_TRUE(IsInView(scan, {0.2, 1.0}));
  EXPECT_FALSE(IsInView(scan, {-1.0, 0.0}));
  scan.reading = {0.0, 2.0 * M_PI / 360.0, 0.05, std::vector<float>(360, 2.0f), 10.0};
  for (const double angle : {-3.0, -1.0, -0.004, 0.0, 1.5, 3.1})
    EXPECT_TRUE(IsInView(scan, {0.2 + std::cos(angle), std::sin(angle)})) << angle;
}

TEST(NearestEchoTest, IsTheShortestThatCounts) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(NearestEcho({4.0F, 2.0F, 3.0F}, 0.1F), 2.0F);
  EXPECT_EQ(NearestEcho({kNan, 0.0F, -1.0F, 3.0F}, 0.1F), 3.0F);
  EXPECT_EQ(NearestEcho({kInf}, 0.1F), kInf);
  EXPECT_TRUE(std::isnan(NearestEcho({}, 0.1F)));
  EXPECT_TRUE(std::isnan(NearestEcho({kNan, 0.05F}, 0.1F)));
}

}  // namespace
}  // namespace hires::robot::echoes_test
