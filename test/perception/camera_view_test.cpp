#include "hires/perception/camera_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hires/geometry/angles.h"
#include "hires/perception/line_of_sight.h"
#include "support/sight_scenes.h"

namespace hires::perception::camera_view_test {
namespace {

TEST(CameraViewTest, BordersOfRangeAndFieldBelongToTheView) {
  CameraView view;  // at the origin, along x
  EXPECT_TRUE(view.Contains({0.4, 0.0, 0.0}));
  EXPECT_FALSE(view.Contains({0.399, 0.0, 0.0}));
  EXPECT_TRUE(view.Contains({3.5, 0.0, 0.0}));
  EXPECT_FALSE(view.Contains({3.501, 0.0, 0.0}));
  EXPECT_FALSE(view.Contains({-1.0, 0.0, 0.0}));
  const double across = std::tan(0.5), up = std::tan(0.785 / 2);
  EXPECT_TRUE(view.Contains({1.0, across - 1e-6, 0.0}));
  EXPECT_FALSE(view.Contains({1.0, across + 1e-6, 0.0}));
  EXPECT_TRUE(view.Contains({1.0, 0.0, up - 1e-6}));
  EXPECT_FALSE(view.Contains({1.0, 0.0, up + 1e-6}));
}

TEST(CameraViewTest, ARobotWithoutACameraCannotLook) {
  EXPECT_THROW(ViewOf(test_support::TrayRobot(), {}, {}), std::logic_error);
}

TEST(CameraViewTest, ShapesStandWhereTheRobotStands) {
  const geometry::Pose2 X_MB{2.0, 1.0, geometry::kPi / 2};
  const auto shapes_M = ShapesOf(test_support::TrayRobot(), X_MB, {});
  ASSERT_EQ(shapes_M.size(), 3u);
  EXPECT_EQ(shapes_M[2].name, "tray");
  // The plate hangs 0.2 m before the base, which heads along y.
  EXPECT_LT((shapes_M[2].X_BS.translation - Eigen::Vector3d(2.0, 1.2, 0.34)).norm(), 1e-9);
}

class Pr2ViewTest : public testing::Test {
 protected:
  const robot::Robot pr2_ = robot::LoadRobot(HIRES_SOURCE_DIR "/config/robots/pr2.yaml");
};

TEST_F(Pr2ViewTest, TurnsWithBaseAndHead) {
  const auto& body = *pr2_.profile.upper_body;
  robot::JointPositions posture = pr2_.profile.joints;
  posture[body.head_pan_joint] = posture[body.head_tilt_joint] = 0.0;
  const CameraView ahead = ViewOf(pr2_, {1.0, 2.0, 0.0}, posture);
  EXPECT_GT(ahead.X_MC.translation.z(), 1.2);
  EXPECT_LT(ahead.X_MC.translation.z(), 1.8);
  const Eigen::Vector3d gaze = ahead.X_MC.rotation * Eigen::Vector3d::UnitX();
  EXPECT_NEAR(gaze.x(), 1.0, 1e-3);
  posture[body.head_pan_joint] = 0.5;
  const CameraView aside = ViewOf(pr2_, {1.0, 2.0, 0.3}, posture);
  EXPECT_NEAR(geometry::YawOf(aside.X_MC.rotation), 0.8, 1e-3);
  posture[body.head_tilt_joint] = 0.6;  // downwards
  const CameraView down = ViewOf(pr2_, {1.0, 2.0, 0.0}, posture);
  EXPECT_LT((down.X_MC.rotation * Eigen::Vector3d::UnitX()).z(), -0.4);
}

TEST_F(Pr2ViewTest, AnOpticalLinkIsTheOneThatLiesAndIsTurnedSo) {
  EXPECT_EQ(FindOpticalLink(pr2_.model, "head_mount_kinect_ir_link"),
            "head_mount_kinect_ir_optical_frame");
  EXPECT_EQ(FindOpticalLink(pr2_.model, "thermal_cam_frame"), "thermal_cam_optical_frame");
  EXPECT_FALSE(FindOpticalLink(pr2_.model, "base_laser_link"));
  EXPECT_FALSE(FindOpticalLink(pr2_.model, "nose"));
}

TEST_F(Pr2ViewTest, TheHeadDoesNotHideWhatLiesBeforeIt) {
  robot::JointPositions posture = pr2_.profile.joints;
  posture[pr2_.profile.upper_body->head_tilt_joint] = 0.3;
  const geometry::Pose2 X_MB{};
  const CameraView view = ViewOf(pr2_, X_MB, posture);
  const LineOfSight sight(std::make_shared<Surroundings>(test_support::SightWorld()), {},
                          ShapesOf(pr2_, X_MB, posture));
  const geometry::Pose3& X_MC = view.X_MC;
  for (double yaw = -0.45; yaw <= 0.45; yaw += 0.15) {
    for (double pitch = -0.3; pitch <= 0.3; pitch += 0.15) {
      const Eigen::Vector3d ray_C =
          geometry::RotationFromRpy(0.0, pitch, yaw) * Eigen::Vector3d::UnitX();
      EXPECT_TRUE(sight.Sees(view, X_MC * (0.9 * ray_C).eval()))
          << "hidden by " << sight.FirstHit(X_MC.translation, X_MC.rotation * ray_C)->name
          << " at yaw " << yaw << ", pitch " << pitch;
    }
  }
}

}  // namespace
}  // namespace hires::perception::camera_view_test
