#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "hires/geometry/polygon.h"
#include "hires/geometry/pose.h"
#include "hires/world/occupancy_grid.h"

namespace hires::navigation {

constexpr std::uint8_t kFreeCost = 0;
constexpr std::uint8_t kInscribedCost = 253;  ///< a robot centred here certainly collides
constexpr std::uint8_t kLethalCost = 254;     ///< an obstacle lies here
constexpr std::uint8_t kUnknownCost = 255;

struct CostmapParams {
  double inflation_radius{0.55};     ///< [m]
  double cost_scaling_factor{10.0};  ///< [1/m], decay beyond the inscribed radius
  bool unknown_is_lethal{true};
};

/// What a base takes up, seen from above [m]: all of it, and what of it there is at the heights of
/// each layer of a costmap.
struct Footprint {
  geometry::Polygon outline;                ///< convex
  std::vector<geometry::Polygon> by_layer;  ///< convex; all of it where none is

  Footprint() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): an outline alone counts at all heights.
  Footprint(geometry::Polygon all) : outline(std::move(all)) {}
  const geometry::Polygon& AtLayer(std::size_t layer) const {
    return layer < by_layer.size() ? by_layer[layer] : outline;
  }
};

/// As geometry::Padded, what is at the heights of layers away from its own middle.
Footprint Padded(const Footprint& footprint, double padding);
/// Its corners move away from the middle of its bounding box.
geometry::Polygon PaddedFromMiddle(const geometry::Polygon& part, double padding);
Footprint Transformed(const geometry::Pose2& X_AB, const Footprint& footprint_B);

/// A grid of traversal costs 0..255 as costmap_2d defines them: 254 at obstacles, 253 within the
/// footprint's inscribed radius, then 252 exp(-k (d - inscribed)) up to the inflation radius.
/// Distances run between cell centres. What stands at heights at which a base is narrower than its
/// outline is in layers, maps of the same cells with inscribed radii of their own: it is in the way
/// of what of the base there is at these heights, and costs no centre more than kInscribedCost.
class Costmap {
 public:
  /// @param inscribed_radius  [m] of the footprint, >= 0.
  /// @pre resolution > 0, width and height >= 1, width * height cells; radii finite and >= 0.
  /// Unknown cells are kUnknownCost and inflated like obstacles if unknown_is_lethal, else free.
  Costmap(const world::OccupancyGrid& grid, double inscribed_radius, const CostmapParams& params);

  double resolution() const { return resolution_; }
  int width() const { return width_; }
  int height() const { return height_; }
  Eigen::Vector2d origin() const { return origin_; }
  std::uint8_t cost(int column, int row) const {
    const std::size_t cell = static_cast<std::size_t>(row) * width_ + column;
    return layers_.empty() ? costs_[cell] : CostWithLayers(cell);
  }
  bool has_layers() const { return !layers_.empty(); }
  const std::vector<std::shared_ptr<const Costmap>>& layers() const { return layers_; }
  /// Whether something stands there, at whatever height; what is unknown does not count.
  bool HasObstacle(int column, int row) const;
  bool Inside(int column, int row) const {
    return column >= 0 && row >= 0 && column < width_ && row < height_;
  }
  void CellOf(const Eigen::Vector2d& point, int* column, int* row) const;
  Eigen::Vector2d CentreOf(int column, int row) const;

  /// Highest cost of all cells that share area with a footprint in the map frame (touching an edge
  /// of a cell is not enough), of each layer with what is at its heights; kLethalCost if a part of
  /// it lies outside the map.
  std::uint8_t CostBelow(const Footprint& footprint_M) const;

  /// Highest cost below the footprint's outline and interior at a pose; kLethalCost outside the
  /// map.
  std::uint8_t FootprintCost(const Footprint& footprint, const geometry::Pose2& X_MB) const;

  /// The same map with one layer more. Centres keep `radius` [m] from what is in it, at most the
  /// inscribed radius. @pre the grid has this map's cells; radius >= 0
  Costmap WithLayer(const world::OccupancyGrid& grid, double radius) const;

  /// The same map with more obstacles in it (convex outlines in the map frame; all cells that share
  /// area with them), inflated, at all heights. Costs a copy of the map and work around the
  /// outlines only.
  Costmap WithObstacles(const std::vector<geometry::Polygon>& outlines_M) const;

  /// The same map with obstacles in the cells that hold these points, inflated, at all heights;
  /// points beyond it are left out.
  Costmap WithObstaclesAt(const std::vector<Eigen::Vector2d>& points_M) const;

  /// The same map for a robot that stands there: all cells that share area with its footprint cost
  /// less than kInscribedCost. Nothing else changes, so that only ways out are opened.
  Costmap WithRoomFor(const Footprint& footprint_M) const;

  /// Likewise, but obstacles stay: a place that is nearer to them than ways should lead is reached.
  Costmap WithAccessTo(const geometry::Polygon& outline_M) const;

  /// Likewise for what is in layers alone.
  Costmap WithAccessUnder(const geometry::Polygon& outline_M) const;

  /// The same obstacles for a robot of another inscribed radius [m]; costs decay beyond it over the
  /// same distance. Radii of layers change by as much. @pre >= 0
  Costmap WithInscribedRadius(double inscribed_radius) const;

 private:
  bool Covers(const geometry::Polygon& outline_M) const;
  std::uint8_t CostWithLayers(std::size_t cell) const;
  std::uint8_t OwnCostBelow(const geometry::Polygon& outline_M) const;  ///< without layers
  /// Below an outline what costs `most` or less costs less than kInscribedCost.
  Costmap Eased(const geometry::Polygon& outline_M, std::uint8_t most) const;
  void SetCostsFrom(const world::OccupancyGrid& grid);
  void Inflate(const std::vector<std::pair<int, int>>& cells);
  std::uint8_t CostAt(double distance) const;  ///< cells to the nearest obstacle, in [m]

  double resolution_;
  int width_, height_;
  Eigen::Vector2d origin_;
  double inscribed_radius_;
  CostmapParams params_;
  std::vector<std::uint8_t> costs_;
  std::vector<std::shared_ptr<const Costmap>> layers_;
};

}  // namespace hires::navigation
