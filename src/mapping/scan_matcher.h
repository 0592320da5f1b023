#pragma once

#include <optional>

#include "mapping/grid_search.h"
#include "mapping/surface_map.h"

namespace hires::mapping {

constexpr double kGoodFit = 0.5;  ///< with less of a scan, a wider search is tried

/// What odometry tells of a pose before the laser is asked.
struct PosePrior {
  geometry::Pose2 X_MB;
  double position_sd{0.0};  ///< [m]
  double yaw_sd{0.0};       ///< [rad]
};

struct ScanMatch {
  geometry::Pose2 X_MB;
  double fit{0.0};  ///< share of the points with normals that lie within 0.1 m on a piece of wall
  /// Inverse of the covariance of x, y [m] in map and yaw [rad]; prior included. Singular where
  /// neither walls nor a prior tell of a direction.
  Eigen::Matrix3d information{Eigen::Matrix3d::Zero()};
  bool is_searched{false};  ///< beyond what odometry allows
};

/// [m^2] in the map; large where nothing tells of a direction.
Eigen::Matrix2d PositionCovarianceOf(const ScanMatch& match);

/// The direction in the map in which least is known of the position.
struct LeastKnown {
  Eigen::Vector2d direction;
  double sd;  ///< [m]
};
LeastKnown LeastKnownOf(const ScanMatch& match);

int NumFacing(const SurfacePoints& points);  ///< points with normals

/// Whether at least 20 points have normals.
bool SeesMuch(const SurfacePoints& points);

/// Share of the points with normals that lie within 0.1 m on a piece of wall; nothing where few
/// have one.
std::optional<double> FitAt(const SurfaceMap& map, const SurfacePoints& points,
                            const geometry::Pose2& X_MB);

/// How a scan fits where anything was seen before.
struct FitWhereSeen {
  int num_points{0};  ///< with normals, within 0.5 m of anything that the map shows
  double fit{0.0};    ///< share of those that lie within 0.1 m on a piece of wall
};
FitWhereSeen FitWhereSeenAt(const SurfaceMap& map, const SurfacePoints& points,
                            const geometry::Pose2& X_MB);

/// From `guess`, by Gauss-Newton on the distances of points to pieces of wall. Normals have noise,
/// which along a hall would add up to more than its few other walls tell: faces that are turned by
/// less than 0.3 rad against most of the others count as parallel to them, and tell nothing along.
/// @param surface_sd  [m] of a point about its wall.
ScanMatch RefineMatch(const SurfaceMap& map, const SurfacePoints& points,
                      const geometry::Pose2& guess, const std::optional<PosePrior>& prior,
                      double surface_sd);

/// What was found by SearchMatch.
struct FoundPose {
  geometry::Pose2 X_MB;
  /// Where else, 0.5 m and more beside it, the points lie at least eight tenths as near to what the
  /// map shows, best of all: alike rooms, or what walls do not tell of. Not asked for in windows of
  /// less than 1.5 m to either side.
  std::optional<geometry::Pose2> X_MRival;
};

/// The pose in the window at which the points lie nearest to what the map shows: of a grid of
/// 0.1 m, then of a finer one about it (GridSearch).
FoundPose SearchMatch(const SurfaceMap& map, const SurfacePoints& points,
                      const geometry::Pose2& guess, const SearchWindow& window);

}  // namespace hires::mapping
