#pragma once

#include <memory>
#include <vector>

#include "hires/base/rng.h"
#include "hires/geometry/polygon.h"
#include "hires/navigation/costmap.h"
#include "hires/perception/point_cloud.h"
#include "hires/sensing/ground_reading.h"
#include "hires/sensing/scan_obstacles.h"
#include "sensing/ground/floor_plane.h"

namespace hires::sensing {

/// Tells what a cloud shows on the way beyond the map: what stands out of the floor, up to the
/// robot's height, and holes in it. A hole lies where the beams that end below the floor go through
/// it. Points over the footprint are the robot's own, and so are all others of it: they must have
/// been cut out before.
class GroundObstacles {
 public:
  /// @param map        what is known to stand there.
  /// @param footprint  of the robot, in its base.
  /// @param scan       its tolerance, range (from the base, in the plane) and cell hold here,
  /// too.
  GroundObstacles(std::shared_ptr<const navigation::Costmap> map, geometry::Polygon footprint,
                  const ScanParams& scan, const GroundParams& params);

  /// @param cloud  of a depth camera, or of a sweep of a tilting laser put together, seen from the
  ///               origin of its frame C.
  /// @param robot_height  [m] what hangs higher is no obstacle.
  /// @param rng    for the search for the floor.
  GroundReading Find(const perception::PointCloud& cloud, const geometry::Pose3& X_BC,
                     const geometry::Pose2& X_MB, double robot_height, base::Rng* rng) const;

 private:
  struct Points {
    std::vector<Eigen::Vector3d> marks_B;  // z: height over the floor
    std::vector<Eigen::Vector2d> floor_B;
  };
  Points Sorted(const std::vector<Eigen::Vector3d>& points_B, const Eigen::Vector3d& p_BC,
                const FloorPlane& floor, double robot_height) const;
  void Count(const Points& points, const geometry::Pose2& X_MB, GroundReading* reading) const;

  std::shared_ptr<const navigation::Costmap> map_;
  geometry::Polygon footprint_;
  ScanParams scan_;
  GroundParams params_;
};

}  // namespace hires::sensing
