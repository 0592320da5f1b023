#pragma once

#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/perception/line_of_sight.h"

namespace hires::perception {

struct DetectorParams {
  double min_visible_share{0.3};  ///< of its surface that faces the camera
  double position_noise{0.005};   ///< [m] sd of each coordinate
  double yaw_noise{0.02};         ///< [rad] sd, about the object's own z axis
};

struct Detection {
  std::string name;  ///< instance
  std::string model;
  geometry::Pose3 X_CO;  ///< in the camera's frame: the localisation error is not the detector's
  double visible_share{0.0};
};

/// Stands in for a camera and a recogniser: which of the true objects are seen, and where.
/// @param objects  true poses; held ones included; all of them known to `sight`.
/// @param rng      the same number of draws for every object, seen or not, so that what hides one
///                 leaves the noise of the others alone.
/// @return in the order of `objects`.
std::vector<Detection> Detect(const LineOfSight& sight, const CameraView& true_view,
                              const std::vector<world::ObjectState>& objects,
                              const DetectorParams& params, base::Rng* rng);

}  // namespace hires::perception
