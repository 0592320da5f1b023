#pragma once

#include <map>
#include <memory>
#include <vector>

#include "hires/base/param_reader.h"
#include "hires/geometry/polygon.h"
#include "hires/navigation/costmap.h"
#include "hires/robot/readings.h"

namespace hires::sensing {

struct ScanParams {
  double tolerance{0.15};  ///< [m] a point this near to an obstacle of the map is that obstacle
  double range{2.5};       ///< [m] obstacle_range of the PR2's costmaps
  double cell{0.05};       ///< [m] edge of the squares that stand for what was seen
};

/// The block `scan` of config/middle_layer.yaml, or a part of another.
/// @throws base::ConfigError naming the key.
ScanParams ReadScanKeys(base::ParamReader* in);
inline ScanParams ReadScanParams(base::ParamReader in) { return ReadScanKeys(&in); }

/// Tells what a scan shows beyond the map.
class ScanObstacles {
 public:
  /// @param map        what is known to stand there.
  /// @param footprint  of the robot, in its base: points within are the robot's own.
  ScanObstacles(std::shared_ptr<const navigation::Costmap> map, geometry::Polygon footprint,
                const ScanParams& params);

  /// Squares in the map around the points that the map does not explain, each cell once.
  std::vector<geometry::Polygon> Find(const robot::ScanReading& scan, const geometry::Pose2& X_MB,
                                      const geometry::Pose2& X_BL) const;

 private:
  std::shared_ptr<const navigation::Costmap> map_;
  geometry::Polygon footprint_;
  ScanParams params_;
};

}  // namespace hires::sensing
