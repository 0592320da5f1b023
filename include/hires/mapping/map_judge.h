#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "hires/localisation/robot_log.h"
#include "hires/world/occupancy_grid.h"

// How true a map is, where the world is known that was mapped. Walls of the world W are the faces
// between an occupied cell and one that is not; of a map M they are its occupied cells.
namespace hires::mapping {

constexpr double kFarthestWall = 0.5;  ///< [m] what is farther from a wall counts as that far

/// How far places on walls are from the nearest wall of another grid [m].
struct WallError {
  double median{kFarthestWall};
  double most{kFarthestWall};  ///< of 95 % of them, at most
  std::size_t count{0};        ///< places; of none of them all is as far as can be
};

/// Both ways: a wall that the map makes up, or has elsewhere, is far from all walls of the world; a
/// wall that the map lacks is far from all walls of the map.
struct WallErrors {
  WallError to_world;  ///< from the map's occupied cells (centres) to the nearest face
  WallError to_map;    ///< from faces that the laser saw (middles) to the nearest occupied cell
};

/// The faces that a laser met: of those within 0.1 m of a beam's end that look towards the laser
/// the nearest one. Each counts once, however often it was met.
/// @param truth  where the base really was in the world's frame, one pose for each scan.
/// @param max_range  [m] beams that ended farther away do not count.
/// @return their middles [m] in W, in the order of the world's cells.
/// @pre one true pose for each scan.
std::vector<Eigen::Vector2d> FacesThatWereSeen(
    const world::OccupancyGrid& world, const std::vector<localisation::RobotLog::Scan>& scans,
    const localisation::TimedPath& truth, double max_range);

/// @param seen_W  as FacesThatWereSeen.
WallErrors JudgeWalls(const world::OccupancyGrid& map, const world::OccupancyGrid& world,
                      const geometry::Pose2& X_WM, const std::vector<Eigen::Vector2d>& seen_W);

}  // namespace hires::mapping
