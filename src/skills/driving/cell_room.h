// Private to this layer: how much room the cells of a map leave a base.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "hires/geometry/polygon.h"
#include "hires/navigation/costmap.h"

namespace hires::skills {

constexpr double kDrivenHeading = 0.52;  ///< [rad] by which a drive's heading is off its way's
constexpr double kHeadingStep = 0.035;   ///< [rad] between headings that are tried
constexpr double kPlaceSteps = 4.0;      ///< places that are tried per cell
constexpr double kFarthestSide = 5.0;    ///< [m] to either side; what is wider is not narrow

/// [m] Across its x.
double WidthOf(const geometry::Polygon& footprint);

/// [m] The least room that a base needs which passes headed along its way, or nearly so.
double NarrowestWidth(const geometry::Polygon& footprint);

/// Whether a cell is no room for anything of a base; or for something of it.  @pre inside the map
bool IsSolid(const navigation::Costmap& costmap, int column, int row);
bool IsTaken(const navigation::Costmap& costmap, int column, int row);

/// Whether the cell there is no room for anything of a base, or is outside of the map.
bool IsObstacle(const navigation::Costmap& costmap, const Eigen::Vector2d& p_M);

/// The square of a cell, by its middle.
geometry::Polygon CellAt(const navigation::Costmap& costmap, const Eigen::Vector2d& cell_M);

struct TakenCell {
  Eigen::Vector2d middle;  ///< in the map
  double distance{0.0};    ///< [m]
};

/// The cell nearest to an outline, no farther than `most` [m], that is no room for something of a
/// base; none: there is no such cell on the map.
std::optional<TakenCell> NearestTakenTo(const navigation::Costmap& costmap,
                                        const geometry::Polygon& outline_M, double most);

/// [m] from a point in a direction to where an obstacle's cell begins; kFarthestSide or more: there
/// is none.
double FreeTowards(const navigation::Costmap& costmap, const Eigen::Vector2d& p_M,
                   const Eigen::Vector2d& along);

}  // namespace hires::skills
