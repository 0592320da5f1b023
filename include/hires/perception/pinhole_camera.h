#pragma once

#include <optional>

#include "hires/geometry/pose.h"

namespace hires::perception {

/// A camera C without distortion that looks along its x axis, y to the left and z up in its
/// picture. The optical axis goes through the picture's middle; the middle of the top left pixel
/// is (0.5, 0.5).
struct PinholeCamera {
  geometry::Pose3 X_MC;
  int width{320}, height{240};  ///< [pixels]
  double focal_length{300.0};   ///< [pixels]

  /// Of length 1, in the map, through a point of the picture [pixels].
  Eigen::Vector3d DirectionAt(double column, double row) const;
  /// Where a point is in the picture (column, row) [pixels], perhaps beyond its borders; nothing
  /// for what is not in front of the camera.
  std::optional<Eigen::Vector2d> Project(const Eigen::Vector3d& p_M) const;
};

/// The optical frame (REP 103: z forward, x right, y down in the picture) in the frame of its
/// camera C.
geometry::Pose3 OpticalFrame();

/// A camera of that field of view at the map's origin.
/// @param field_of_view  [rad] from the left border to the right one, 0 .. pi.
PinholeCamera CameraOf(int width, int height, double field_of_view);

/// A camera at `eye_M` that has `target_M` in the middle of its picture and the horizon level.
/// @param field_of_view  [rad] from the left border to the right one, 0 .. pi.
/// @pre eye and target differ, and one is not above the other.
PinholeCamera LookAt(const Eigen::Vector3d& eye_M, const Eigen::Vector3d& target_M, int width,
                     int height, double field_of_view);

}  // namespace hires::perception
