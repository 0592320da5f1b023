#pragma once

#include <Eigen/Core>
#include <vector>

namespace hires::perception {

/// A piece of surface that is about level, and how its points scatter.
struct LevelPatch {
  Eigen::Vector3d p_C{Eigen::Vector3d::Zero()};  ///< [m] mean of its points, in the camera's frame
  double reach{0.0};                             ///< [m] of its points from the one it is about
  double scatter{0.0};                           ///< [m] sd of them along its normal
};

/// The surface about some hundred of the points, where it is as level as that; other planes and
/// edges are left out. A patch reaches as far as 0.1 of its distance from the camera.
/// @param points           [m] in the camera's frame; time grows with them: some thousand are
/// enough.
/// @param up_C             of length 1
/// @param max_inclination  [rad] of the surface's normal against it
std::vector<LevelPatch> LevelPatchesIn(const std::vector<Eigen::Vector3d>& points,
                                       const Eigen::Vector3d& up_C, double max_inclination);

/// The scatter of points on level surfaces against what a depth camera's points have there: the
/// lower quartile of the patches, as things and edges add to others.
/// @return [DepthNoise]; 0 where too few patches tell.
double ScatterOf(const std::vector<LevelPatch>& patches);

/// The same of those on a plane.
/// @param up_C, offset  of the plane: up_C . p + offset is the height above it [m]
double ScatterOn(const std::vector<LevelPatch>& patches, const Eigen::Vector3d& up_C,
                 double offset);

}  // namespace hires::perception
