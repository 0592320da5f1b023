#include "hires/perception/pinhole_camera.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hires::perception::pinhole_camera_test {
namespace {

using Eigen::Vector3d;

constexpr double kRightAngle = 1.5707963267948966;

TEST(PinholeCameraTest, PointsAreWhereTheProjectionByHandPutsThem) {
  // 200 x 100 pixels, 90 degrees wide: focal length 100 pixels.
  const PinholeCamera camera = LookAt({0, 0, 1}, {5, 0, 1}, 200, 100, kRightAngle);
  EXPECT_NEAR(camera.focal_length, 100.0, 1e-9);
  const auto middle = camera.Project({3, 0, 1});
  ASSERT_TRUE(middle);
  EXPECT_TRUE(middle->isApprox(Eigen::Vector2d(100, 50), 1e-12));
  const auto up_left = camera.Project({10, 1, 2});  // 1 m to the left and 1 m up, 10 m away
  ASSERT_TRUE(up_left);
  EXPECT_TRUE(up_left->isApprox(Eigen::Vector2d(90, 40), 1e-12));
}

TEST(PinholeCameraTest, WhatIsBehindIsNotInThePicture) {
  const PinholeCamera camera = LookAt({0, 0, 1}, {5, 0, 1}, 200, 100, kRightAngle);
  EXPECT_FALSE(camera.Project({-1, 0, 1}));
}

TEST(PinholeCameraTest, TheRayThroughAPixelMeetsWhatIsProjectedThere) {
  const PinholeCamera camera = LookAt({2, -3, 1.7}, {-1, 4, 0.3}, 320, 240, 0.8);
  for (double column = 0.5; column < 320; column += 31.9) {
    for (double row = 0.5; row < 240; row += 23.9) {
      const Vector3d p_M = camera.X_MC.translation + 2.7 * camera.DirectionAt(column, row);
      EXPECT_TRUE(camera.Project(p_M)->isApprox(Eigen::Vector2d(column, row), 1e-9));
    }
  }
}

TEST(PinholeCameraTest, TheHorizonIsLevelAndUpIsUp) {
  const PinholeCamera camera = LookAt({2, -3, 1.7}, {-1, 4, 0.3}, 320, 240, 0.8);
  const auto low = camera.Project({-1, 4, 0.0}), high = camera.Project({-1, 4, 1.0});
  EXPECT_NEAR(low->x(), high->x(), 1e-9);
  EXPECT_GT(low->y(), high->y());
}

TEST(OpticalFrameTest, LooksAlongZWithXToTheRightAndYDown) {
  const geometry::Pose3 X_CO = OpticalFrame();
  EXPECT_TRUE((X_CO * Vector3d(0, 0, 2)).isApprox(Vector3d(2, 0, 0), 1e-12));
  EXPECT_TRUE((X_CO * Vector3d(1, 0, 0)).isApprox(Vector3d(0, -1, 0), 1e-12));
  EXPECT_TRUE((X_CO * Vector3d(0, 1, 0)).isApprox(Vector3d(0, 0, -1), 1e-12));
}

TEST(PinholeCameraTest, StraightDownHasNoHorizon) {
  EXPECT_THROW(LookAt({0, 0, 2}, {0, 0, 0}, 10, 10, 0.8), std::logic_error);
}

}  // namespace
}  // namespace hires::perception::pinhole_camera_test
