#pragma once

#include <cmath>

#include "hires/perception/line_of_sight.h"
#include "hires/perception/point_cloud.h"

namespace hires::test_support {

/// A sweep of a PR2's tilting laser, put together: beams of 1.396 rad to both sides, tilted from
/// 0.7 rad up to 1.05 rad down.
struct TiltSweep {
  int num_beams{640}, num_tilts{100};
  double noise{0.005};     ///< [m] sd of each range
  double max_range{10.0};  ///< [m]

  /// @param X_ML  the laser, not tilted, x forward.
  /// @return organised, in L.
  perception::PointCloud Measure(const perception::LineOfSight& sight, const geometry::Pose3& X_ML,
                                 base::Rng* rng) const {
    perception::PointCloud cloud{num_beams, num_tilts, {}};
    for (int i = 0; i < num_tilts; ++i) {
      const double tilt = -0.7 + 1.75 * i / (num_tilts - 1);
      for (int k = 0; k < num_beams; ++k) {
        const double angle = -1.396 + 2.792 * k / (num_beams - 1);
        const Eigen::Vector3d direction_L(std::cos(angle) * std::cos(tilt), std::sin(angle),
                                          -std::cos(angle) * std::sin(tilt));
        const double range =
            sight.Cast(X_ML.translation, X_ML.rotation * direction_L) + rng->Normal(0.0, noise);
        const double nothing = std::numeric_limits<double>::quiet_NaN();
        cloud.points.push_back(
            ((range <= max_range ? range : nothing) * direction_L).cast<float>());
      }
    }
    return cloud;
  }
};

}  // namespace hires::test_support
