#include "hires/robot/scan_memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hires/base/rng.h"
#include "hires/robot/echoes.h"
#include "support/planar_scan.h"

namespace hires::robot::scan_memory_test {
namespace {

using Eigen::Vector2d;
using geometry::Polygon;
using geometry::Pose2;
using test_support::Beams;

const Polygon kBody{{0.3, -0.3}, {0.3, 0.3}, {-0.3, 0.3}, {-0.3, -0.3}};
const Pose2 X_BL{0.28, 0.0, 0.0};

/// A thin leg, at (1, 0.02) in the world.
const Polygon kLeg{{0.98, 0.0}, {1.02, 0.0}, {1.02, 0.04}, {0.98, 0.04}};

class ScanMemoryTest : public testing::Test {
 protected:
  /// One scan of a robot that stands at X_WB.
  PlacedScan Scan(const Pose2& X_WB, const std::vector<Polygon>& outlines) {
    PlacedScan scan = test_support::ScanOf(outlines, X_WB, X_WO_.Inverse() * X_WB, X_BL, beams_);
    memory_.Complete(time_ += 0.1, &scan);
    return scan;
  }
  /// [m] from the leg to the nearest point that the scan or the memory has; huge: there is none.
  double OffLeg(const PlacedScan& scan) const {
    const Vector2d leg_O = X_WO_.Inverse() * Vector2d(1.0, 0.02);
    double least = 1e9;
    for (const Vector2d& p_O : scan.out_of_view_O) least = std::min(least, (p_O - leg_O).norm());
    for (const Vector2d& p_B : EchoesOf(scan, kBody))
      least = std::min(least, (scan.X_OB * p_B - leg_O).norm());
    return least;
  }

  ScanMemory memory_{kBody};
  Beams beams_;
  double time_{0.0};
  Pose2 X_WO_{0.3, -0.2, 0.4};
};

TEST_F(ScanMemoryTest, WhatIsInViewIsLeftToTheScan) {
  Scan({}, {kLeg});
  EXPECT_TRUE(Scan({}, {kLeg}).out_of_view_O.empty());
  EXPECT_TRUE(Scan({}, {}).out_of_view_O.empty()) << "seen to be gone";
}

TEST_F(ScanMemoryTest, WhatComesNearerThanTheLaserMeasuresStays) {
  beams_.range_min = 0.5;
  for (double x = 0.0; x < 0.66; x += 0.02) {
    ASSERT_LT(OffLeg(Scan({x, 0.0, 0.0}, {kLeg})), 0.03) << x;
  }
  time_ += 300.0;
  EXPECT_LT(OffLeg(Scan({0.65, 0.0, 0.0}, {kLeg})), 0.03) << "however long it stands there";
}

/// Odometry errs by some per cent: after a metre beside a thing it says little of where that is.
TEST_F(ScanMemoryTest, WhatWasTooNearForAMetreIsForgotten) {
  beams_.range_min = 0.5;
  for (double x = 0.0; x < 0.6; x += 0.02) Scan({x, 0.0, 0.0}, {kLeg});
  PlacedScan scan;
  for (int i = 0; i < 60; ++i) scan = Scan({0.6 + 0.02 * (i % 2), 0.0, 0.0}, {kLeg});
  EXPECT_TRUE(scan.out_of_view_O.empty());
}

TEST_F(ScanMemoryTest, WhatTurnsOutOfViewStaysForTenSeconds) {
  for (double yaw = 0.0; yaw < 3.0; yaw += 0.1) {
    ASSERT_LT(OffLeg(Scan({0.0, 0.0, yaw}, {kLeg})), 0.03) << yaw;
  }
  time_ += 5.0;
  EXPECT_LT(OffLeg(Scan({0.0, 0.0, 3.0}, {kLeg})), 0.03);
  time_ += 10.0;
  EXPECT_TRUE(Scan({0.0, 0.0, 3.0}, {kLeg}).out_of_view_O.empty());
}

TEST_F(ScanMemoryTest, WhatABeamThatMeasuresNothingLooksAtStays) {
  Scan({}, {kLeg});
  PlacedScan blind = test_support::ScanOf({kLeg}, {}, X_WO_.Inverse(), X_BL, beams_);
  for (float& range : blind.reading.ranges) range = std::nanf("");
  memory_.Complete(time_ += 0.1, &blind);
  EXPECT_LT(OffLeg(blind), 0.03);
}

TEST_F(ScanMemoryTest, TheRobotItselfAndWhatIsFarAreNotRemembered) {
  const Polygon within{{0.29, -0.02}, {0.29, 0.02}, {0.31, 0.02}, {0.31, -0.02}};
  const Polygon far{{1.7, -1.0}, {1.8, -1.0}, {1.8, 1.0}, {1.7, 1.0}};
  beams_.range_min = 0.0;
  for (double yaw = 0.0; yaw < 3.0; yaw += 0.1)
    ASSERT_TRUE(Scan({0.0, 0.0, yaw}, {geometry::Transformed({0.0, 0.0, yaw}, within), far})
                    .out_of_view_O.empty());
}

TEST_F(ScanMemoryTest, WhereClockOrOdometryBeginAgainAllIsForgotten) {
  for (double yaw = 0.0; yaw < 3.0; yaw += 0.1) Scan({0.0, 0.0, yaw}, {kLeg});
  ScanMemory before = memory_;
  X_WO_ = {5.0, 1.0, 0.0};
  EXPECT_TRUE(Scan({0.0, 0.0, 3.0}, {kLeg}).out_of_view_O.empty());
  X_WO_ = {0.3, -0.2, 0.4};
  memory_ = before;
  time_ -= 100.0;
  EXPECT_TRUE(Scan({0.0, 0.0, 3.0}, {kLeg}).out_of_view_O.empty());
}

TEST_F(ScanMemoryTest, PointsDoNotPileUp) {
  base::Rng rng(3);
  beams_.rng = &rng;
  std::size_t most = 0;
  for (int i = 0; i < 500; ++i) {  // to and fro at the edge of the view
    time_ -= 0.09;
    most = std::max(most, Scan({0.0, 0.0, 1.71 + 0.08 * (i % 2)}, {kLeg}).out_of_view_O.size());
  }
  EXPECT_GT(most, 0u) << "else this shows nothing";
  EXPECT_LT(most, 60u) << "as many as fit, a centimetre apart, where a noisy leg is seen";
}

}  // namespace
}  // namespace hires::robot::scan_memory_test
