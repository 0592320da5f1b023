#pragma once

#include <Eigen/Core>
#include <string>

#include "hires/geometry/pose.h"

namespace hires::geometry {

/// How a robot's map lies in the world that is imagined: "the applied affine transformation"
/// between AMCL's map and the simulated world (dissertation, section 5.6). Calculated once for a
/// laboratory; the identity where the world was drawn in the map's frame.
struct MapToWorld {
  Pose2 X_WM;         ///< the map's origin and axes in the world
  double scale{1.0};  ///< metres of the world per metre of the map

  bool is_identity() const;
  Eigen::Vector2d ToWorld(const Eigen::Vector2d& p_M) const;
  Pose2 ToWorld(const Pose2& X_MB) const;  ///< X_WB
  Pose2 ToMap(const Pose2& X_WB) const;    ///< X_MB
};

/// Reads "x y yaw" or "x y yaw scale" [m, m, rad, -]; an empty text is the identity.
/// @param where  of the text, for messages.
/// @throws base::ConfigError: other than 3 or 4 numbers, not finite, scale outside 0.5 .. 2.
MapToWorld ParseMapToWorld(const std::string& text, const std::string& where);

}  // namespace hires::geometry
