// Private to this layer: what a base takes up at which heights, and what of a world stands there.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "hires/geometry/polygon.h"
#include "hires/navigation/costmap.h"
#include "hires/robot/robot_profile.h"
#include "hires/world/occupancy_grid.h"

namespace hires::skills {

constexpr double kHeightStep = 0.05;   ///< [m] in which heights are told apart
constexpr double kHeightSlack = 0.05;  ///< [m] that is kept over and under each shape
constexpr double kNarrower = 0.05;     ///< [m] by less than which outlines are alike

using Band = std::pair<double, double>;  ///< [m] heights over the floor

/// The heights at which a base is narrower than its footprint, all in the same way.
struct NarrowHeights {
  std::vector<Band> bands;
  geometry::Polygon outline;  ///< [m] convex, in base_link
};

/// The heights from the lowest obstacle that matters to a base's top.
struct HeightSplit {
  std::vector<Band> whole;  ///< there it counts as its footprint
  std::vector<NarrowHeights> narrow;
};

/// Convex outline in base_link [m] of all shapes within lower..upper [m]; joints in the driving
/// posture. Shapes of the tray's link reach up to wherever what stands on it may.
/// None: no shape is there.
std::optional<geometry::Polygon> ShapesWithin(const robot::Robot& robot, const Band& band);

/// Where the footprint is that of the model's shapes (to kNarrower) and no arm or torso moves: by
/// heights in steps of kHeightStep, shapes counted kHeightSlack higher and lower than they are.
/// Heights without a shape between others count as the whole footprint, for something there must
/// hold the upper ones; all of them do for every other robot.
HeightSplit SplitByHeight(const robot::Robot& robot, double lowest, double highest);

/// What stands in a world between two heights [m], in the same cells: what is in the way of the
/// whole base, and layer by layer what is in the way of less. Without layers where nothing stands
/// at such heights that is not in the way of the whole base.
struct SlicedByHeight {
  struct Layer {
    world::OccupancyGrid map;
    geometry::Polygon outline;  ///< NarrowHeights
  };
  world::OccupancyGrid whole;
  std::vector<Layer> layers;
};
SlicedByHeight SliceByHeight(const world::World& world, const robot::Robot& robot, const Band& band,
                             double resolution, double margin);

/// What is occupied in one map is in the other one, too. @pre both have the same cells
void Occupy(const world::OccupancyGrid& more, world::OccupancyGrid* grid);

/// A costmap with the layers' obstacles. A centre keeps so far from these that nothing touches them
/// whichever way it heads, but no farther than the whole base has to.
/// @param whole  of what is in the way of the whole base, with its inscribed radius.
navigation::Costmap Layered(navigation::Costmap whole,
                            const std::vector<SlicedByHeight::Layer>& layers,
                            const robot::Robot& robot);

/// The footprint, padded, with what of it is at the layers' heights, padded as well.
navigation::Footprint BodyOf(const geometry::Polygon& padded,
                             const std::vector<SlicedByHeight::Layer>& layers,
                             const robot::Robot& robot);

}  // namespace hires::skills
