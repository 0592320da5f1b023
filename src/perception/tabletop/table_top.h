#pragma once

#include <Eigen/Core>
#include <vector>

#include "hires/perception/table.h"

namespace hires::perception {

struct TablePlane {
  Eigen::Vector3d normal;  ///< of length 1, upwards
  double offset;           ///< [m] of the camera above it
};

struct TablePoint {
  Eigen::Vector3d p;  ///< [m] in the camera's frame
  double tolerance;   ///< [m] by which it may be off a plane that it is on
};

bool Supports(const TablePlane& plane, const TablePoint& point);

Table TableIn(const TablePlane& plane);  ///< without an outline

/// What of a plane is the table: all pieces of it that are not small, as things hide what is
/// between them, while other furniture beside the table crosses the plane in small ones.
struct TableTop {
  std::vector<TablePoint> points{};
  std::vector<Eigen::Vector3d> border{};  ///< those of its hull's corners, and more
};

TableTop TopOf(const std::vector<TablePoint>& points, const Table& table);

/// Points without those that have as much closely below and above them, as on walls and on what
/// stands upright; what remains is about level. Of very many points only some are looked at.
/// @param level       along what the others are
/// @param tolerances  of each point, within which what is as high as it is
std::vector<TablePoint> WithoutUpright(const std::vector<TablePoint>& points, const Table& level,
                                       double tolerances);

}  // namespace hires::perception
