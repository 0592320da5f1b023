#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/perception/recogniser.h"
#include "perception/recognition/distance_field.h"

namespace hires::perception {

/// All models of a catalogue that have one geometry; nothing that measures distances tells them
/// apart.
struct ModelShape {
  std::vector<KnownModel> models{};  ///< by label
  std::shared_ptr<const DistanceField> field{};
  bool is_round{false};  ///< about its z axis: its yaw cannot be seen
  double foot{0.0};      ///< [m] height of the origin above what it stands on
};

/// @return in the order of the labels.
std::vector<ModelShape> ShapesOfCatalogue(const std::vector<KnownModel>& catalogue);

/// The smallest rectangle around points, seen from above; x along its longer side.
struct Footprint {
  geometry::Pose2 X_TF{};          ///< of its middle
  double length{0.0}, width{0.0};  ///< [m]
};

/// @param p_T  at least one.
Footprint FootprintOf(const std::vector<Eigen::Vector3d>& p_T);

/// Points of one thing in the frame T of its table: z upwards from the table's plane, with the
/// camera above its origin.
struct ThingPoints {
  std::vector<Eigen::Vector3d> p_T{};
  std::vector<double> sd{};  ///< [m] of each
};

struct ModelPose {
  geometry::Pose2 X_TO{};  ///< standing upright on the table
  double misfit{1.0};      ///< mean over the points of the squared distance [sd], cut at 9, / 9
};

/// Moves a standing model until its surface is nearest to the points: Gauss and Newton's method on
/// the distances to the surface, with weights that fade out what is far [Levenberg-Marquardt ICP on
/// a distance field: Fitzgibbon 2003, "Robust registration of 2D and 3D point sets"]; for round
/// models without their yaw, as the iterative distance fitter does (dissertation, 4.4).
/// It begins behind the points' mean; models that are not round also in all four quarters, and with
/// the corner that is nearest to the camera in that of the points' footprint.
ModelPose FitModel(const ModelShape& shape, const ThingPoints& thing, const Footprint& footprint);

}  // namespace hires::perception
