#pragma once

#include <vector>

#include "hires/base/rng.h"
#include "hires/geometry/polygon.h"
#include "hires/geometry/pose.h"
#include "hires/robot/readings.h"
#include "support/planar_rays.h"

namespace hires::test_support {

/// Of a laser: where its beams go, and how they err.
struct Beams {
  double angle_min{-2.0}, increment{0.02};  ///< [rad]
  int count{201};
  double range_min{0.05}, range_max{10.0};  ///< [m]
  base::Rng* rng{nullptr};                  ///< null: they do not err
  double noise{0.01};                       ///< [m] sd
};

/// What such a laser sees of outlines in its plane.
inline robot::PlacedScan ScanOf(const std::vector<geometry::Polygon>& outlines,
                                const geometry::Pose2& X_WB, const geometry::Pose2& X_OB,
                                const geometry::Pose2& X_BL, const Beams& beams = {}) {
  robot::PlacedScan scan;
  scan.X_OB = X_OB;
  scan.X_BL = X_BL;
  scan.reading = {beams.angle_min, beams.increment, beams.range_min, {}, beams.range_max};
  const geometry::Pose2 X_WL = X_WB * X_BL;
  for (int i = 0; i < beams.count; ++i) {
    const double angle = X_WL.yaw + beams.angle_min + i * beams.increment;
    double range = RangeTo(outlines, X_WL.position(), angle);
    if (beams.rng != nullptr) range += beams.rng->Normal(0.0, beams.noise);
    scan.reading.ranges.push_back(static_cast<float>(range));
  }
  return scan;
}

}  // namespace hires::test_support
