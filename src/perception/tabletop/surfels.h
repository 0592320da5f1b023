#pragma once

#include <Eigen/Core>
#include <vector>

#include "hires/perception/point_cloud.h"
#include "hires/perception/segmentation_params.h"

namespace hires::perception {

/// A surface element: what the points in one cell of a grid say of the surface there, in the
/// camera's frame.
struct Surfel {
  Eigen::Vector3d p_C{Eigen::Vector3d::Zero()};      ///< [m] mean of its points
  Eigen::Vector3d normal{Eigen::Vector3d::UnitZ()};  ///< of length 1, towards the camera
  int num_points{0};
};

struct SurfelCloud {
  std::vector<Surfel> surfels{};
  std::vector<int> of_point{};  ///< surfel of each point of the cloud; -1: not asked for
  std::vector<std::vector<int>> neighbours{};  ///< within the border radius, of each surfel
};

/// @param indices  of the points that count; all of them measured.
/// @pre border_radius >= normal_radius
SurfelCloud MakeSurfels(const PointCloud& cloud, const std::vector<int>& indices,
                        const SurfelParams& params);

}  // namespace hires::perception
