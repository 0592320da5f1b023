#pragma once

#include <string>

#include "hires/localisation/odometry_filter.h"

namespace hires_ros {

struct OdometryFilterNodeParams {
  hires::localisation::OdometryFilterConfig config;  ///< config/odometry_filter.yaml
  std::string odometry_frame, base_frame;            ///< of the names file
};

/// From the private parameters config and names.
/// @throws hires::base::ConfigError naming file and key.
OdometryFilterNodeParams LoadOdometryFilterNodeParams();

}  // namespace hires_ros
