#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace hires::perception {

struct RansacPlaneParams {
  double tolerance;        ///< [m] from the plane, of points that are on it
  double max_inclination;  ///< [rad] between `up` and its normal on the camera's side
  int max_samples;         ///< planes through three points that are tried at most
};

/// The plane that most points are on, of those that look up on the side on which the camera, the
/// origin, is; by PCL's RANSAC [pcl::RandomSampleConsensus; Fischler, Bolles 1981], which ends when
/// a better one has been missed once in a hundred times. The same points give the same plane: PCL
/// draws from a seed of its own.
/// @param points  [m]
/// @param up      of length 1
/// @return a, b, c, d >= 0 with a x + b y + c z + d = 0 [m], (a, b, c) of length 1; nothing where
/// three points are on none.
/// @throws base::ConfigError in programs that are built without PCL.
std::optional<Eigen::Vector4d> FindPlaneByRansac(const std::vector<Eigen::Vector3d>& points,
                                                 const Eigen::Vector3d& up,
                                                 const RansacPlaneParams& params);

}  // namespace hires::perception
