#include "hires/perception/depth_sensor.h"

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"

namespace hires::perception {
namespace {

constexpr double kRightAngle = 1.5707963267948966;
constexpr double kSteep = 1.0472;     // [rad] 60 degrees
constexpr double kShadowStep = 0.02;  // [m] behind what casts the shadow
constexpr float kUnmeasured = std::numeric_limits<float>::quiet_NaN();

// Pixels of one row that the projector does not see: something nearer stands in the same column of
// the projector's picture.
std::vector<bool> ShadowOf(const float* depth, int width, double disparity_of_one_metre) {
  const int margin = static_cast<int>(disparity_of_one_metre / 0.2);  // nothing nearer is measured
  std::vector<float> nearest(width + margin + 2, std::numeric_limits<float>::infinity());
  const auto column_of = [&](int i) {  // shifted, so that none is negative
    return std::max(0.0, i - disparity_of_one_metre / depth[i] + margin);
  };
  for (int i = 0; i < width; ++i) {
    if (!std::isfinite(depth[i])) continue;
    const auto column = static_cast<std::size_t>(column_of(i));
    for (const std::size_t covered : {column, column + 1})
      nearest[covered] = std::min(nearest[covered], depth[i]);
  }
  std::vector<bool> is_hidden(width, false);
  for (int i = 0; i < width; ++i) {
    is_hidden[i] = std::isfinite(depth[i]) &&
                   nearest[static_cast<std::size_t>(column_of(i) + 0.5)] < depth[i] - kShadowStep;
  }
  return is_hidden;
}

// The pixel itself, or at an edge one nearby.
int Flickered(const RangePicture& picture, int row, int column, double dx, double dy, double edge) {
  const int here = row * picture.width + column;
  const int x = std::clamp(column + static_cast<int>(std::lround(dx)), 0, picture.width - 1);
  const int y = std::clamp(row + static_cast<int>(std::lround(dy)), 0, picture.height - 1);
  const int there = y * picture.width + x;
  const bool is_edge = !(std::abs(picture.depth[there] - picture.depth[here]) <= edge);
  return is_edge ? there : here;
}

}  // namespace

double DepthNoise(double z, double incidence) {
  const double facing = 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4);
  if (incidence < kSteep) return facing;
  const double rest = std::max(kRightAngle - incidence, 1e-3);
  return facing + 0.0001 / std::sqrt(z) * incidence * incidence / (rest * rest);
}

PointCloud Measure(const RangePicture& picture, const PinholeCamera& camera,
                   const DepthSensorParams& params, base::Rng* rng) {
  HIRES_CHECK(picture.width == camera.width && picture.height == camera.height,
              "the picture is another camera's");
  PointCloud cloud;
  cloud.width = picture.width;
  cloud.height = picture.height;
  cloud.points.reserve(picture.depth.size());
  for (int row = 0; row < picture.height; ++row) {
    const std::vector<bool> is_hidden =
        ShadowOf(&picture.depth[static_cast<std::size_t>(row) * picture.width], picture.width,
                 camera.focal_length * params.baseline);
    for (int column = 0; column < picture.width; ++column) {
      const double dx = rng->Normal(0.0, params.lateral_noise);
      const double dy = rng->Normal(0.0, params.lateral_noise);
      const double along = rng->Normal(0.0, 1.0);
      const int seen = Flickered(picture, row, column, dx, dy, params.edge);
      const double z = picture.depth[seen];
      const double incidence = std::acos(std::min(1.0F, picture.incidence[seen]));
      if (is_hidden[column] || !(z >= params.min_range && z <= params.max_range) ||
          incidence > params.max_incidence) {
        cloud.points.emplace_back(Eigen::Vector3f::Constant(kUnmeasured));
        continue;
      }
      const double measured = z + along * params.depth_noise * DepthNoise(z, incidence);
      const Eigen::Vector3d ray((column + 0.5 - camera.width / 2.0) / camera.focal_length,
                                (row + 0.5 - camera.height / 2.0) / camera.focal_length, 1.0);
      cloud.points.push_back((measured * ray).cast<float>());
    }
  }
  return cloud;
}

PointCloud Measure(const LineOfSight& sight, const PinholeCamera& camera,
                   const DepthSensorParams& params, base::Rng* rng) {
  // Rays through the picture's corners go farthest.
  const double across = 0.5 * std::hypot(camera.width, camera.height) / camera.focal_length;
  const double farthest = params.max_range * std::hypot(1.0, across);
  return Measure(sight.Look(camera, farthest), camera, params, rng);
}

}  // namespace hires::perception
