#pragma once

#include <optional>
#include <vector>

#include "hires/perception/table.h"
#include "perception/tabletop/surfels.h"

namespace hires::perception {

/// What one part looks like to who stands above the table.
struct PartShape {
  geometry::Polygon outline{};                      ///< Table::FromAbove [m]
  Eigen::Vector2d middle{Eigen::Vector2d::Zero()};  ///< mean of the outline's corners [m]
  double top{0.0};          ///< [m] above the table, of all but 2 % of the surfels
  double inner_share{0.0};  ///< of its surfels, on walls that face the middle
  double inward{0.0};  ///< how far its normals, seen from above, turn to the middle: 1 all, -1 none
};

bool LieOnOneLine(const std::vector<Eigen::Vector2d>& points);  ///< @pre there is one

/// @return nothing where the surfels lie on one line, seen from above.
std::optional<PartShape> ShapeOf(const SurfelCloud& all, const std::vector<int>& members,
                                 const Table& table);

struct Face {
  Eigen::Vector3d normal;
  double offset;
  bool Holds(const Surfel& surfel, double tolerance) const;
};

/// Up to three planes that hold at least 15 % of the surfels each.
/// @param tolerance  [m] of surfels to their face.
std::vector<Face> FacesOf(const SurfelCloud& all, std::vector<int> members, double tolerance,
                          base::Rng rng);

}  // namespace hires::perception
