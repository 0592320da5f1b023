#pragma once

#include "hires/geometry/map_to_world.h"
#include "hires/world/occupancy_grid.h"

namespace hires::world {

/// How well a map and a slice of the world agree. All shares lie in [0, 1].
struct MapFit {
  double explained{0.0};  ///< of the map's obstacles that the world has there too
  double found{0.0};      ///< of the world's obstacles, where the map knows anything, that it shows
  double score{0.0};      ///< harmonic mean of the two: 1 is perfect, 0 nothing in common
};

struct MapFitParams {
  double tolerance{0.15};    ///< [m] obstacles so near to each other are the same
  double min_score{0.5};     ///< of a map that belongs to the world; people and boxes that stand
                             ///< about, and walls that were not drawn, cost some
  double worth_saying{0.1};  ///< a transformation nearby that is better by so much is the right one
  double search_distance{1.0};  ///< [m] within which a better transformation is looked for
  double search_angle{0.3};     ///< [rad] likewise
};

/// @param map    what the robot has driven and saved.
/// @param slice  of the world at the height of the robot's laser.
MapFit FitMap(const OccupancyGrid& map, const OccupancyGrid& slice,
              const geometry::MapToWorld& map_to_world, double tolerance);

/// Accepts the transformation if it is good enough and as good as what lies around it (walls along
/// which a map is shifted agree with themselves), or says how far off it is: "... fits with 0.21,
/// wanted 0.5 or more; with -0.40 0.00 0.10 1 it would be 0.93". The search tries a lattice of
/// shifts and turns.
/// @throws base::ConfigError.
MapFit RequireMapFits(const OccupancyGrid& map, const OccupancyGrid& slice,
                      const geometry::MapToWorld& map_to_world, const MapFitParams& params);

}  // namespace hires::world
