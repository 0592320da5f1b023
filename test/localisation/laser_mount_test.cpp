#include "hires/localisation/laser_mount.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hires/geometry/angles.h"

namespace hires::localisation::laser_mount_test {
namespace {

using geometry::kPi;
using geometry::Pose3;

/// Where a beam of one metre ends in the base.
Eigen::Vector2d EndOf(const geometry::Pose2& X_BL, const robot::ScanReading& scan, int beam) {
  const double angle = scan.angle_min + beam * scan.angle_increment;
  return X_BL * Eigen::Vector2d(std::cos(angle), std::sin(angle));
}

TEST(LaserMountTest, BeamsOfALevelLaserAndOfOneUpsideDownEndWhereItsPoseSays) {
  for (const double roll : {0.0, 0.05, kPi, kPi - 0.05}) {
    const Pose3 X_BL{{0.3, -0.1, 0.25}, geometry::RotationFromRpy(roll, 0.0, 0.7)};
    const robot::ScanReading measured{-1.0, 0.5, 0.0, {1.0f, 1.0f, 1.0f}, 10.0};
    robot::ScanReading scan = measured;
    const auto level = LevelLaser(X_BL, &scan);
    ASSERT_TRUE(level) << roll;
    for (int beam = 0; beam < 3; ++beam) {
      const double angle = measured.angle_min + beam * measured.angle_increment;
      const Eigen::Vector3d end = X_BL * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
      EXPECT_LT((EndOf(*level, scan, beam) - end.head<2>()).norm(), 2e-3) << roll;
    }
  }
}

TEST(LaserMountTest, TiltedLaserIsRefused) {
  robot::ScanReading scan;
  for (const double roll : {0.2, kPi / 2.0, kPi - 0.2}) {
    EXPECT_FALSE(LevelLaser({{}, geometry::RotationFromRpy(roll, 0.0, 0.0)}, &scan)) << roll;
  }
}

}  // namespace
}  // namespace hires::localisation::laser_mount_test
