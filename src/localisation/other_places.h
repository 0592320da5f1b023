#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/world/occupancy_grid.h"

namespace hires::localisation {

/// A drive as somebody believes that it went through a map, all in the map's frame [m].
struct DriveSketch {
  std::vector<Eigen::Vector2d> echoes_M;  ///< where beams ended
  std::vector<Eigen::Vector2d> way_M;     ///< where the base was
};

/// Where else in the map the whole drive fits: poses X_MS of the sketch, as it lies, of which the
/// first ones fit best. The sketch at such a place has as many echoes near an obstacle as where it
/// is believed to be, or up to 6 % fewer, and as much of its way in free cells, less 5 %; it is
/// more than 1 m from there and from the others, at the middle of its way, or turned by more than
/// 0.5 rad.
///
/// All places are tried: branch and bound over boxes of shifts, for each of the headings that move
/// no echo by more than a cell [Olson 2009, ICRA, "Real-time correlative scan matching"; Hess et
/// al. 2016, ICRA, "Real-time loop closure in 2D LIDAR SLAM"].
/// @param explained_distance  [m] an echo that ends so near to an obstacle is explained.
/// @param most                places that are told.
/// @param task                what is done, for those who wait.
/// @pre width and height >= 1, width * height cells, resolution > 0
std::vector<geometry::Pose2> FindOtherPlaces(const world::OccupancyGrid& map,
                                             const DriveSketch& sketch, double explained_distance,
                                             int most, const std::string& task);

}  // namespace hires::localisation
