#pragma once

#include <Eigen/Core>
#include <cstdint>
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

/// A grid of traversal costs 0..255 as costmap_2d defines them: 254 at obstacles, 253 within the
/// footprint's inscribed radius, then 252 exp(-k (d - inscribed)) up to the inflation radius.
/// Distances run between cell centres.
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
    return costs_[static_cast<std::size_t>(row) * width_ + column];
  }
  bool Inside(int column, int row) const {
    return column >= 0 && row >= 0 && column < width_ && row < height_;
  }
  void CellOf(const Eigen::Vector2d& point, int* column, int* row) const;
  Eigen::Vector2d CentreOf(int column, int row) const;

  /// Highest cost of all cells that share area with a convex outline in the map frame (touching
  /// an edge of a cell is not enough); kLethalCost if a part of it lies outside the map.
  std::uint8_t CostBelow(const geometry::Polygon& outline_M) const;

  /// Highest cost below the footprint's outline and interior at a pose; kLethalCost outside the
  /// map.
  std::uint8_t FootprintCost(const geometry::Polygon& footprint, const geometry::Pose2& X_MB) const;

  /// The same map with more obstacles in it (convex outlines in the map frame; all cells that share
  /// area with them), inflated. Costs a copy of the map and work around the outlines only.
  Costmap WithObstacles(const std::vector<geometry::Polygon>& outlines_M) const;

  /// The same map with obstacles in the cells that hold these points, inflated; points beyond it
  /// are left out.
  Costmap WithObstaclesAt(const std::vector<Eigen::Vector2d>& points_M) const;

  /// The same map for a robot that stands there: all cells that share area with a convex outline
  /// cost less than kInscribedCost. Nothing else changes, so that only ways out are opened.
  Costmap WithRoomFor(const geometry::Polygon& outline_M) const;

  /// Likewise, but obstacles stay: a place that is nearer to them than ways should lead is reached.
  Costmap WithAccessTo(const geometry::Polygon& outline_M) const;

  /// The same obstacles for a robot of another inscribed radius [m]; costs decay beyond it over the
  /// same distance. @pre >= 0
  Costmap WithInscribedRadius(double inscribed_radius) const;

 private:
  bool Covers(const geometry::Polygon& outline_M) const;
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
};

}  // namespace hires::navigation
