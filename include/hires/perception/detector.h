#pragma once

#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/perception/camera_view.h"

namespace hires::perception {

struct DetectorParams {
  double min_visible_share{0.3};  ///< of its surface that faces the camera
  double position_noise{0.005};   ///< [m] sd of each coordinate
  double yaw_noise{0.02};         ///< [rad] sd
};

struct Detection {
  std::string name;  ///< instance
  std::string model;
  geometry::Pose3 X_CO;  ///< in the camera's frame: the localisation error is not the detector's
  double visible_share{0.0};
};

/// Stands in for a camera and a recogniser: which of the true objects are seen, and where.
/// @param objects  true poses; held ones included.
std::vector<Detection> Detect(const LineOfSight& sight, const CameraView& true_view,
                              const std::vector<world::ObjectState>& objects,
                              const DetectorParams& params, base::Rng* rng);

}  // namespace hires::perception
