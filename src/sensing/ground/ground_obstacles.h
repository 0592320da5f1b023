#pragma once

#include <memory>
#include <vector>

#include "hires/base/rng.h"
#include "hires/geometry/polygon.h"
#include "hires/navigation/costmap.h"
#include "hires/perception/point_cloud.h"
#include "hires/sensing/scan_obstacles.h"
#include "sensing/ground/floor_plane.h"

namespace hires::sensing {

struct GroundParams {
  FloorParams floor{};
  double min_height{0.03};  ///< [m] over the floor, from which on it is an obstacle
  double min_depth{0.05};   ///< [m] below the floor, likewise: a hole, a stair down
  int min_points{3};        ///< of a cell, before it counts
};

struct GroundReading {
  FloorPlane floor;
  std::vector<geometry::Polygon> obstacles_M;  ///< squares, each cell once
};

/// Tells what a cloud shows on the way beyond the map: what stands out of the floor, up to the
/// robot's height, and holes in it. A hole lies where the beams that end below the floor go through
/// it. Points over the footprint are the robot's own, and so are all others of it: they must have
/// been cut out before.
class GroundObstacles {
 public:
  /// @param map           what is known to stand there.
  /// @param footprint     of the robot, in its base.
  /// @param scan          its tolerance, range (from the base, in the plane) and cell hold here,
  /// too.
  /// @param robot_height  [m] what hangs higher is no obstacle.
  GroundObstacles(std::shared_ptr<const navigation::Costmap> map, geometry::Polygon footprint,
                  const ScanParams& scan, const GroundParams& params, double robot_height);

  /// @param cloud  of a depth camera, or of a sweep of a tilting laser put together, in frame C.
  /// @param p_CE   [m] where the cloud was seen from: of a sweep, where the laser tilts about.
  /// @param rng    for the search for the floor.
  GroundReading Find(const perception::PointCloud& cloud, const Eigen::Vector3d& p_CE,
                     const geometry::Pose3& X_BC, const geometry::Pose2& X_MB,
                     base::Rng* rng) const;

 private:
  std::vector<Eigen::Vector3d> Marks(const std::vector<Eigen::Vector3d>& points_B,
                                     const Eigen::Vector3d& p_BE, const FloorPlane& floor) const;
  std::vector<geometry::Polygon> Squares(const std::vector<Eigen::Vector3d>& marks_B,
                                         const geometry::Pose2& X_MB) const;

  std::shared_ptr<const navigation::Costmap> map_;
  geometry::Polygon footprint_;
  ScanParams scan_;
  GroundParams params_;
  double robot_height_;
};

}  // namespace hires::sensing
