#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

namespace hires::perception {

/// What a depth camera measured, in its optical frame (REP-103: z forward, x right, y down), seen
/// from the origin.
struct PointCloud {
  int width{0};   ///< [pixels] of an organised cloud, which is stored row by row from the top left
  int height{1};  ///< [pixels]; 1: not organised
  std::vector<Eigen::Vector3f> points{};  ///< [m], width * height; NaN: nothing measured there
};

inline bool IsMeasured(const Eigen::Vector3f& p_C) { return p_C.allFinite(); }

/// Standard deviation [m] of a structured-light camera's depth along its axis, `z` [m] away.
/// [Nguyen, Izadi, Lovell 2012, "Modeling Kinect Sensor Noise for Improved 3D Reconstruction and
/// Tracking", 3DIMPVT, Eq. 3, for surfaces that face the camera]
inline double DepthNoise(double z) { return 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4); }

}  // namespace hires::perception
