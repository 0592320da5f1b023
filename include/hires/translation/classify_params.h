#pragma once

#include "hires/base/param_reader.h"

namespace hires::translation {

/// When a symbol holds.
struct ClassifyParams {
  double area_distance{0.25};       ///< [m] from an area's pose that counts as being there
  double area_yaw{0.35};            ///< [rad]
  double tucked_tolerance{0.1};     ///< [rad] sum over the arm's joints (PR2's tuck_arms)
  double posture_tolerance{0.3};    ///< [rad] likewise, other postures
  double torso_tolerance{0.02};     ///< [m]
  double placing_height{0.10};      ///< [m] above or below a placing area
  double tray_height{0.05};         ///< [m] above or below the tray
  double hysteresis{1.2};           ///< a symbol that holds already may be so many times off...
  double placing_hysteresis{0.02};  ///< [m] ... or so far beyond the edge
};

/// The block `classify` of config/scene.yaml.
/// @throws base::ConfigError naming file and key.
ClassifyParams ReadClassifyParams(base::ParamReader in);

}  // namespace hires::translation
