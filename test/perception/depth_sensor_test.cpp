#include "hires/perception/depth_sensor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hires/perception/line_of_sight.h"
#include "support/sight_scenes.h"

namespace hires::perception::depth_sensor_test {
namespace {

using Eigen::Vector3d;

/// A wall across the camera's axis, `distance` [m] away, and a plate of 0.4 m before it.
RangePicture WallAndPlate(const PinholeCamera& camera, double distance, double plate) {
  world::World world;
  world.statics = {test_support::Block("wall", {0.02, 20.0, 20.0}, {distance + 0.01, 0.0, 5.0}),
                   test_support::Block("plate", {0.02, 0.4, 0.4}, {plate + 0.01, 0.0, 5.0})};
  return LineOfSight(std::make_shared<Surroundings>(world), {}).Look(camera, 10.0);
}

const PinholeCamera kCamera = LookAt({0.0, 0.0, 5.0}, {1.0, 0.0, 5.0}, 160, 120, 1.0);

PointCloud Measured(const RangePicture& picture, const DepthSensorParams& params, int seed = 1) {
  base::Rng rng(seed);
  return Measure(picture, kCamera, params, &rng);
}

const Eigen::Vector3f& At(const PointCloud& cloud, int column, int row) {
  return cloud.points[row * cloud.width + column];
}

TEST(DepthNoiseTest, IsAsPublished) {
  EXPECT_NEAR(DepthNoise(1.0), 0.001884, 1e-6);
  EXPECT_NEAR(DepthNoise(2.0), 0.006064, 1e-6);
  EXPECT_EQ(DepthNoise(1.0, 0.9), DepthNoise(1.0)) << "below 60 degrees the angle does not count";
  EXPECT_NEAR(DepthNoise(1.0, 1.3) - DepthNoise(1.0), 0.0001 * 1.69 / 0.07333, 1e-5);
}

TEST(DepthSensorTest, DepthErrsAsFarAsThePaperSays) {
  const PointCloud cloud = Measured(WallAndPlate(kCamera, 2.0, 1.0), {});
  double sum = 0.0, squares = 0.0;
  int n = 0;
  for (int row = 0; row < 20; ++row) {  // beside the plate and its shadow
    for (int column = 0; column < 40; ++column) {
      const Eigen::Vector3f& p = At(cloud, column, row);
      ASSERT_TRUE(IsMeasured(p));
      sum += p.z() - 2.0;
      squares += (p.z() - 2.0) * (p.z() - 2.0);
      ++n;
      const double focal = kCamera.focal_length;  // the point lies on its pixel's ray
      ASSERT_NEAR(p.x() / p.z(), (column + 0.5 - 80.0) / focal, 1e-6);
      ASSERT_NEAR(p.y() / p.z(), (row + 0.5 - 60.0) / focal, 1e-6);
    }
  }
  EXPECT_NEAR(std::sqrt(squares / n), DepthNoise(2.0), 5.0 * DepthNoise(2.0) / std::sqrt(2.0 * n));
  EXPECT_NEAR(sum / n, 0.0, 5.0 * DepthNoise(2.0) / std::sqrt(n));
}

// By similar triangles: the shadow is as wide as the baseline, scaled from the plate to the wall.
TEST(DepthSensorTest, TheProjectorsShadowLiesBesideWhatCastsIt) {
  DepthSensorParams params;
  params.lateral_noise = 0.0;
  const PointCloud cloud = Measured(WallAndPlate(kCamera, 2.0, 1.0), params);
  const int row = 60;
  int left = 0, right = 0;
  for (int column = 0; column < 160; ++column) {
    if (IsMeasured(At(cloud, column, row))) continue;
    ++(column < 80 ? left : right);
  }
  const double disparity = kCamera.focal_length * params.baseline * (1.0 / 1.0 - 1.0 / 2.0);
  EXPECT_EQ(right, 0) << "the projector stands on the right";
  EXPECT_NEAR(left, disparity, 1.5);
}

TEST(DepthSensorTest, EdgesFlickerAndSurfacesDoNot) {
  const RangePicture picture = WallAndPlate(kCamera, 2.0, 1.0);
  int flickering = 0;
  const PointCloud one = Measured(picture, {}, 1), other = Measured(picture, {}, 2);
  for (int row = 0; row < 120; ++row) {
    for (int column = 0; column < 160; ++column) {
      const Eigen::Vector3f &a = At(one, column, row), &b = At(other, column, row);
      if (!IsMeasured(a) || !IsMeasured(b) || std::abs(a.z() - b.z()) < 0.5F) continue;
      ++flickering;
      const double x = (column + 0.5 - 80.0) / kCamera.focal_length;  // at 1 m
      const double y = (row + 0.5 - 60.0) / kCamera.focal_length;
      const double from_edge = std::abs(std::max(std::abs(x), std::abs(y)) - 0.2);
      ASSERT_LT(from_edge * kCamera.focal_length, 5.0) << column << ", " << row;
    }
  }
  EXPECT_GT(flickering, 50);
}

TEST(DepthSensorTest, NothingIsMeasuredTooNearTooFarOrAtAGrazingAngle) {
  const auto is_empty = [](const PointCloud& cloud) {
    return std::none_of(cloud.points.begin(), cloud.points.end(), IsMeasured);
  };
  EXPECT_TRUE(is_empty(Measured(WallAndPlate(kCamera, 0.7, 0.6), {})));
  EXPECT_TRUE(is_empty(Measured(WallAndPlate(kCamera, 4.0, 3.8), {})));
  EXPECT_FALSE(is_empty(Measured(WallAndPlate(kCamera, 3.0, 2.0), {})));
  DepthSensorParams strict;
  strict.max_incidence = 0.0;
  EXPECT_TRUE(is_empty(Measured(WallAndPlate(kCamera, 3.0, 2.0), strict)));
}

TEST(DepthSensorTest, WithoutNoiseDepthsAreExact) {
  DepthSensorParams params;
  params.depth_noise = params.lateral_noise = 0.0;
  const PointCloud cloud = Measured(WallAndPlate(kCamera, 2.0, 1.0), params);
  EXPECT_NEAR(At(cloud, 10, 60).z(), 2.0, 1e-6);
  EXPECT_NEAR(At(cloud, 80, 60).z(), 1.0, 1e-6);
}

TEST(DepthSensorTest, TheSameSeedGivesTheSameBits) {
  const RangePicture picture = WallAndPlate(kCamera, 2.0, 1.0);
  const PointCloud one = Measured(picture, {}), again = Measured(picture, {});
  for (std::size_t i = 0; i < one.points.size(); ++i) {
    if (IsMeasured(one.points[i])) {
      ASSERT_EQ(one.points[i], again.points[i]);
    }
  }
}

}  // namespace
}  // namespace hires::perception::depth_sensor_test
