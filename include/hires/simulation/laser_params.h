#pragma once

#include <string>

#include "hires/base/param_reader.h"

namespace hires::simulation {

/// A planar laser: beams in the x-y plane of its link. The defaults are those of the PR2's base
/// laser in the original simulation.
struct LaserParams {
  std::string link{"base_laser_link"};
  int num_beams{640};
  double angle_min{-2.2689}, angle_max{2.2689};  ///< [rad] of the first and the last beam
  double range_min{0.08}, range_max{10.0};       ///< [m]
  double noise{0.005};                           ///< [m] sd of each range
  /// [rad] across. A beam that meets two surfaces mixes them; 0: beams are lines.
  double beam_width{0.0};
  double mixing_depth{0.75};  ///< [m] by which echoes differ that are told apart
  bool sees_robot{false};     ///< its own links; a beam leaves the link that it begins in
};

/// Beams, angles and ranges; unknown keys are left to who has the reader.
/// @throws base::ConfigError naming file and key.
LaserParams ReadBeams(base::ParamReader* in);

/// The same, and its noise.
LaserParams ReadLaser(base::ParamReader* in);

}  // namespace hires::simulation
