#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "hires/perception/point_cloud.h"

namespace hires::perception {

/// A cloud as the picture of a pinhole camera at its origin, whose optical frame it is in.
struct CloudPicture {
  /// Of length 1, through the middle of a pixel.
  Eigen::Vector3d DirectionAt(int column, int row) const;
  /// (column, row) of a point in front of the camera, perhaps beyond the borders.
  Eigen::Vector2d Project(const Eigen::Vector3d& p_C) const;
  int PointAt(int column, int row) const {
    return point[static_cast<std::size_t>(row) * width + column];
  }

  int width{0}, height{0};                              ///< [pixels]
  Eigen::Array2d focal_length{Eigen::Array2d::Ones()};  ///< [pixels] across and down
  Eigen::Array2d middle{Eigen::Array2d::Zero()};        ///< [pixels] of the optical axis
  std::vector<int> point{};  ///< of each pixel, row by row; -1: nothing measured
};

/// Of an organised cloud its own pixels, whose camera is found by least squares. One that is not
/// organised, or that no pinhole camera took, is drawn into a picture of 400 pixels a radian; the
/// nearest of the points that fall into one pixel counts.
/// @return nothing where no point lies in front of the camera.
std::optional<CloudPicture> PictureOf(const PointCloud& cloud);

}  // namespace hires::perception
