#include "sim_robot/sim_robot_cameras.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "sim_robot/sensor_scenes.h"
#include "sim_robot/sim_robot_sensors.h"
#include "support/messages.h"
#include "support/rounds.h"

namespace hires::sim_robot::sim_robot_cameras_test {
namespace {

using hires::test_support::PlateSetup;
using hires::test_support::PlateStart;
using perception::PointCloud;

SimCameraParams WithoutNoise() {
  SimSensorParams params;
  DropNoise(&params);
  return params.cameras;
}

SimRobotCameras CamerasIn(const SimRobotWorld& world, const SimCameraParams& params, int seed = 1) {
  return {params, base::Rng(seed), world.scene()};
}

/// The plate's outline in the picture [pixels, the middle of the top left one at 0, 0]: its corners
/// through the matrix of projection that camera_info and tf stand for, by OpenCV.
std::vector<cv::Point2f> PlateOutline(const SimRobotWorld& world,
                                      const perception::PinholeCamera& camera) {
  const geometry::Pose3 X_OM =
      world.simulator().X_MLink("head_mount_kinect_ir_optical_frame").Inverse();
  const Eigen::Matrix3d R = X_OM.rotation.toRotationMatrix();
  const Eigen::Vector3d& t = X_OM.translation;
  const double f = camera.focal_length;
  const cv::Matx44d K(f, 0, camera.width / 2.0 - 0.5, 0, 0, f, camera.height / 2.0 - 0.5, 0,  //
                      0, 0, 0, 1, 0, 0, 1, 0);
  const cv::Matx44d X(R(0, 0), R(0, 1), R(0, 2), t.x(), R(1, 0), R(1, 1), R(1, 2), t.y(),  //
                      R(2, 0), R(2, 1), R(2, 2), t.z(), 0, 0, 0, 1);
  std::vector<cv::Point3f> corners, projected;
  for (const float x : {1.999F, 2.001F}) {
    for (const float y : {-0.15F, 0.35F}) {
      for (const float z : {1.1F, 1.5F}) corners.emplace_back(x, y, z);
    }
  }
  cv::perspectiveTransform(corners, projected, K * X);
  std::vector<cv::Point2f> points, outline;
  for (const cv::Point3f& p : projected) points.emplace_back(p.x, p.y);
  cv::convexHull(points, outline);
  return outline;
}

/// Pixels beyond `margin` [pixels] from the outline on whose side `is_plate` is wrong.
template <typename IsPlate>
int NumWrong(const std::vector<cv::Point2f>& outline, int width, int height, double margin,
             const IsPlate& is_plate) {
  int num_wrong = 0;
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const double inside = cv::pointPolygonTest(outline, cv::Point2f(column, row), true);
      if (std::abs(inside) > margin && is_plate(column, row) != (inside > 0.0)) ++num_wrong;
    }
  }
  return num_wrong;
}

TEST(SimRobotCamerasTest, TheCloudIsWhereOpenCvProjectsThingsWithinHalfAPixel) {
  SimRobotWorld world(PlateSetup(), PlateStart(), 1);
  const SimRobotCameras cameras = CamerasIn(world, WithoutNoise());
  const SeenCloud seen = cameras.See(world, world.Sense());
  ASSERT_EQ(seen.cloud.width, 640);
  ASSERT_EQ(seen.cloud.height, 480);
  const auto outline = PlateOutline(world, cameras.depth_camera());
  ASSERT_GT(cv::contourArea(outline), 10000.0);
  const geometry::Pose3 X_MO = seen.X_MC * perception::OpticalFrame();
  EXPECT_EQ(NumWrong(outline, 640, 480, 0.5,
                     [&](int column, int row) {
                       const Eigen::Vector3f& p_O = seen.cloud.points[row * 640 + column];
                       if (!perception::IsMeasured(p_O)) return false;
                       return std::abs((X_MO * p_O.cast<double>().eval()).x() - 2.0) < 0.01;
                     }),
            0);
}

/// Mean of what the plate's points are off in the map, as the robot places them, in x [m].
double PlateError(SimRobotWorld& world, const SimRobotCameras& cameras) {
  const SeenCloud seen = cameras.See(world, world.Sense());
  const geometry::Pose3 X_MO = seen.X_MC * perception::OpticalFrame();
  double sum = 0.0;
  int num = 0;
  for (const Eigen::Vector3f& p_O : seen.cloud.points) {
    if (!perception::IsMeasured(p_O)) continue;
    const double x = (X_MO * p_O.cast<double>().eval()).x();
    if (std::abs(x - 2.0) > 0.2) continue;
    sum += x - 1.999;  // the plate's face
    ++num;
  }
  return num > 0 ? sum / num : std::nan("");
}

TEST(SimRobotCamerasTest, ATruthWithABiasShowsThingsOffByItTheSameAtEveryLook) {
  SimRobotWorld world(PlateSetup(), PlateStart(), 1);
  Truth truth;
  truth.sensing = Sensing::kPictures;
  SimSensorParams quiet;
  DropNoise(&quiet);
  EXPECT_NEAR(PlateError(world, CamerasIn(world, SensorsOf(truth, quiet).cameras)), 0.0, 1e-4);
  truth.recogniser.bias = 0.02;
  const SimCameraParams biased = SensorsOf(truth, quiet).cameras;
  double squares = 0.0;
  const int num_seeds = test_support::Rounds(40);
  for (int seed = 1; seed <= num_seeds; ++seed) {
    const SimRobotCameras cameras = CamerasIn(world, biased, seed);
    const double error = PlateError(world, cameras);
    EXPECT_EQ(PlateError(world, cameras), error);
    squares += error * error / num_seeds;
  }
  // About 2.7 times the deviation of a root mean square of so many.
  EXPECT_NEAR(std::sqrt(squares), truth.recogniser.bias,
              1.9 / std::sqrt(num_seeds) * truth.recogniser.bias);
}

TEST(SimRobotCamerasTest, ThePictureIsWhereOpenCvProjectsThings) {
  const SimRobotWorld world(PlateSetup(), PlateStart(), 1);
  SimRobotCameras cameras = CamerasIn(world, {});
  const perception::Picture picture = cameras.Colours(world);
  const auto outline = PlateOutline(world, cameras.depth_camera());
  const cv::Moments whole = cv::moments(outline);
  const double column = whole.m10 / whole.m00, row = whole.m01 / whole.m00;
  const perception::Colour plate = picture.At(std::lround(column), std::lround(row));
  // Pixels that the outline crosses are blends; it crosses none farther off than half a diagonal.
  const auto is_plate = [&](int x, int y) { return picture.At(x, y) == plate; };
  EXPECT_EQ(NumWrong(outline, 640, 480, 0.71, is_plate), 0);
  double num = 0.0, columns = 0.0, rows = 0.0;
  for (int y = 0; y < 480; ++y) {
    for (int x = 0; x < 640; ++x) {
      if (!is_plate(x, y)) continue;
      ++num;
      columns += x;
      rows += y;
    }
  }
  EXPECT_NEAR(columns / num, column, 0.5);
  EXPECT_NEAR(rows / num, row, 0.5);
}

TEST(SimRobotCamerasTest, AskedTwiceTheySayTheSameAndLaterSomethingElse) {
  SimRobotWorld world(PlateSetup(), PlateStart(), 1);
  const SimRobotCameras cameras = CamerasIn(world, {}), others = CamerasIn(world, {}, 2);
  const auto depths = [&](const SimRobotCameras& camera) {
    std::vector<float> z;
    for (const Eigen::Vector3f& p : camera.Cloud(world).points) {
      z.push_back(perception::IsMeasured(p) ? p.z() : -1.0F);
    }
    return z;
  };
  const auto first = depths(cameras);
  EXPECT_EQ(depths(cameras), first);
  EXPECT_NE(depths(others), first);
  EXPECT_EQ(cameras.Heat(world).centikelvin, cameras.Heat(world).centikelvin);
  world.Advance(50);
  EXPECT_NE(depths(cameras), first);
}

TEST(SimRobotCamerasTest, TheCloudComesWithTheBelievedPlaceNotTheTrueOne) {
  SimRobotWorld world(
      PlateSetup("localisation_x: {distribution: fixed, value: 0.1, unit: m, source: test}"),
      PlateStart(), 1);
  const geometry::Pose3 X_MC = world.simulator().X_MLink("head_mount_kinect_ir_link");
  const SensorReadings readings = world.Sense();
  const SeenCloud seen = CamerasIn(world, WithoutNoise()).See(world, readings);
  ASSERT_GT(std::abs(readings.X_MB.x), 0.05);
  EXPECT_NEAR(seen.X_MC.translation.x() - X_MC.translation.x(), readings.X_MB.x, 1e-3);
}

TEST(SimRobotCamerasTest, WhatIsWarmIsWarmInThePictureAndNothingElse) {
  const SimRobotWorld world(PlateSetup(), PlateStart(), 1);
  SimCameraParams params = WithoutNoise();
  params.temperatures = {{"tower1", 340.0}};
  const SimRobotCameras cameras = CamerasIn(world, params);
  const perception::HeatPicture heat = cameras.Heat(world);
  ASSERT_EQ(heat.centikelvin.size(), 640u * 480u);
  perception::PinholeCamera camera = cameras.heat_camera();
  EXPECT_NEAR(camera.focal_length, 320.0, 0.01) << "as published";
  camera.X_MC = world.simulator().X_MLink("thermal_cam_frame");
  const auto at = [&](const Eigen::Vector3d& p_M) {
    const Eigen::Vector2d pixel = *camera.Project(p_M);
    return heat.centikelvin[static_cast<int>(pixel.y()) * 640 + static_cast<int>(pixel.x())];
  };
  EXPECT_EQ(at({1.8, -0.5, 0.4}), 34000);
  EXPECT_EQ(at({1.8, -0.5 + 0.06, 0.4}), 29315) << "0.06 m beside its axis, of radius 0.037 m";
  EXPECT_EQ(at({2.0, 0.1, 1.3}), 29315);
  EXPECT_EQ(cameras.InColours(heat).At(0, 0)[0], 46) << "5 K of 55 K from blue to red";
}

TEST(SimRobotCamerasTest, PicturesAreDueAtTheirPeriods) {
  SimRobotWorld world(PlateSetup(), PlateStart(), 1);
  const SimRobotCameras cameras = CamerasIn(world, {});
  int depth = 0, heat = 0;
  for (int tick = 0; tick < 40; ++tick) {  // 2 s
    depth += cameras.IsDepthDue(world) ? 1 : 0;
    heat += cameras.IsHeatDue(world) ? 1 : 0;
    world.Advance(kSensorTick);
  }
  EXPECT_EQ(depth, 2);
  EXPECT_EQ(heat, 10);
}

TEST(SimRobotCamerasTest, ARobotWithoutThemHasNone) {
  const auto scene = hires::test_support::RoomScene();
  const SimRobotCameras cameras({}, base::Rng(1), scene);
  EXPECT_FALSE(cameras.has_depth_camera());
  EXPECT_FALSE(cameras.has_thermal_camera());
}

TEST(SensorsOfTest, PicturesAreSeenAndIdealSensorsDoNotErr) {
  Truth truth;
  EXPECT_FALSE(SensorsOf(truth, {}).sees_pictures);
  truth.sensing = Sensing::kPictures;
  EXPECT_TRUE(SensorsOf(truth, {}).sees_pictures);
  truth.sensing = Sensing::kIdeal;
  const SimSensorParams ideal = SensorsOf(truth, {});
  EXPECT_EQ(ideal.laser.noise + ideal.lasers.tray.noise + ideal.lasers.tilting.noise, 0.0);
  EXPECT_EQ(ideal.cameras.depth.depth_noise + ideal.cameras.heat.noise, 0.0);
  truth.sensing = Sensing::kFitted;
  EXPECT_EQ(SensorsOf(truth, {}).cameras.heat.noise, 0.05);
}

}  // namespace
}  // namespace hires::sim_robot::sim_robot_cameras_test
