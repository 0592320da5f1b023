#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "hires/geometry/polygon.h"
#include "hires/geometry/pose.h"
#include "hires/navigation/costmap.h"
#include "hires/navigation/obstacle_layer.h"
#include "hires/robot/observation.h"
#include "hires/skills/scan_watch.h"

namespace hires::skills {

/// A map by what the base's laser can see of it; constant, shared by all skills of a scene.
struct MapByPlane {
  /// Without what is in the laser's plane: tops of tables, seats of chairs, thresholds.
  std::shared_ptr<const navigation::Costmap> beyond;
  std::vector<Eigen::Vector2d> in_plane_M;  ///< [m] centres of the cells that it can see
};

/// What local control goes by: round the robot what the laser sees in its plane replaces what the
/// map has there. For that lies where the robot's place in the map puts it, and that errs; what was
/// seen lies where it is against the robot. Of what the laser cannot see, and where it has not
/// looked, the map alone tells. Where the odometry was reset, or its clock, nobody knows any more
/// where the robot saw what: all that was seen is forgotten. A value: a copy goes on like the
/// original.
class LocalCostmap {
 public:
  /// @param map        shared.
  /// @param footprint  of the robot, in its base: what is seen within is the robot.
  LocalCostmap(const MapByPlane* map, const navigation::ObstacleLayerParams& params,
               geometry::Polygon footprint, double inflation_radius);

  /// From now on for a robot of another inscribed radius [m].
  void SetInscribedRadius(double radius);

  /// One look. The answer changes with a new scan, or where the robot's place in the map does.
  const std::shared_ptr<const navigation::Costmap>& Look(const robot::Observation& observation);
  /// [m] Centres of the cells that echoes marked, in the map as the robot believes to stand in it.
  std::vector<Eigen::Vector2d> Marks(const robot::Observation& observation) const;

 private:
  std::vector<Eigen::Vector2d> Obstacles(const robot::Observation& observation) const;

  const MapByPlane* map_;
  geometry::Polygon footprint_;
  double reach_;  // [m] so far from the robot obstacles matter
  navigation::ObstacleLayer layer_;
  std::shared_ptr<const navigation::Costmap> beyond_;  // inflated for this robot
  ScanWatch watch_;
  std::shared_ptr<const navigation::Costmap> now_;
  geometry::Pose2 X_OM_;  // of that
};

}  // namespace hires::skills
