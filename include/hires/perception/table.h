#pragma once

#include <Eigen/Core>
#include <optional>

#include "hires/geometry/polygon.h"
#include "hires/perception/point_cloud.h"

namespace hires::perception {

/// The plane of a table in the camera's frame, seen from above.
struct Table {
  /// [m] above the plane; negative below it.
  double HeightOf(const Eigen::Vector3d& p_C) const { return normal.dot(p_C) + offset; }
  /// Along the plane [m], for what is seen from above.
  Eigen::Vector2d FromAbove(const Eigen::Vector3d& p_C) const {
    return {along_x.dot(p_C), along_y.dot(p_C)};
  }
  /// The point of the plane that is seen there from above.
  Eigen::Vector3d Lift(const Eigen::Vector2d& p) const {
    return p.x() * along_x + p.y() * along_y - offset * normal;
  }

  Eigen::Vector3d normal{Eigen::Vector3d::UnitY() * -1.0};  ///< of length 1, upwards
  double offset{0.0};                                       ///< [m] height of the camera above it
  Eigen::Vector3d along_x{Eigen::Vector3d::UnitX()};        ///< of length 1, as is the next;
  Eigen::Vector3d along_y{-Eigen::Vector3d::UnitZ()};       ///< with the normal right-handed
  geometry::Polygon outline{};  ///< convex, of its measured points, FromAbove [m]
  double noise{1.0};            ///< [DepthNoise] sd by which its points are judged
};

/// How the camera stands, where somebody knows it.
struct CameraStand {
  Eigen::Vector3d up_C{-Eigen::Vector3d::UnitY()};  ///< of length 1
  double height{0.0};                               ///< [m] above the floor
};

struct TableParams {
  int num_samples{300};    ///< planes through three points; ten times as many are tried at most
  double tolerance{2.0};   ///< [DepthNoise] from the plane, of points that vote for it
  double min_share{0.05};  ///< of all measured points, at least on a table
  double max_inclination{0.2};  ///< [rad] against what is level, where that is known
  double min_height{0.55};      ///< [m] of a table above the floor, where that is known
  double max_height{1.3};       ///< [m] likewise
};

/// The plane with the most points of which the camera is on the upper side (FindPlaneByRansac, then
/// least squares). Where two tables are seen, the larger one in the picture. Points that scatter
/// more on it than a depth camera's are judged by their own scatter (Table::noise).
/// @param stand  without it the camera is taken to be upright, or to look straight down from at
/// most 2.5 m, and a table is any plane that is no wall then; the floor too, where none as large as
/// params has it is 0.45 m or more above it. Over a floor wider than 2.5 m a plane 0.55 m or more
/// above it on which things stand may be smaller: it needs 200 points and `min_share` of what is
/// there but upright.
/// @return nothing where no plane holds `min_share` of the points, and 200 of them.
std::optional<Table> FindTable(const PointCloud& cloud, const std::optional<CameraStand>& stand,
                               const TableParams& params);

/// A plate whose place is known to some centimetres, where the cloud has it: the plane of the
/// points about it (their median, then least squares), as kinematics errs by more than a thing is
/// high that lies flat. Its outline moves along.
/// @return the plate as expected where too few points are about it, or they lie otherwise by more
///         than a calibration does.
Table PlateIn(const PointCloud& cloud, Table expected, const TableParams& params);

}  // namespace hires::perception
