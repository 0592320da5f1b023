#pragma once

#include "hires/base/rng.h"
#include "hires/perception/pinhole_camera.h"
#include "hires/perception/tabletop/point_cloud.h"
#include "perception/ray_scene.h"

namespace hires::test_support {

/// What a depth camera with DepthNoise along its axis measures.
inline perception::PointCloud DepthPicture(const perception::RayScene& scene,
                                           const perception::PinholeCamera& camera, base::Rng rng) {
  perception::PointCloud cloud;
  cloud.width = camera.width;
  cloud.height = camera.height;
  const Eigen::Matrix3d R_CM = camera.X_MC.rotation.toRotationMatrix().transpose();
  for (int row = 0; row < camera.height; ++row) {
    for (int column = 0; column < camera.width; ++column) {
      const Eigen::Vector3d direction = camera.DirectionAt(column + 0.5, row + 0.5);
      const auto hit = scene.FirstHit(camera.X_MC.translation, direction, 5.0);
      const Eigen::Vector3d d = R_CM * direction;  // x forward, y left, z up
      const Eigen::Vector3d ray(-d.y() / d.x(), -d.z() / d.x(), 1.0);
      const double noise = rng.Normal(0.0, 1.0);
      if (!hit) {
        cloud.points.emplace_back(
            Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
        continue;
      }
      const double z = hit->distance * d.x();
      cloud.points.push_back((ray * (z + noise * perception::DepthNoise(z))).cast<float>());
    }
  }
  return cloud;
}

}  // namespace hires::test_support
