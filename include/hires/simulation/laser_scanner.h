#pragma once

#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/simulation/robot_simulator.h"

namespace hires::simulation {

/// A planar laser: beams in the x-y plane of its link. The defaults are those of the PR2's base
/// laser in the original simulation.
struct LaserParams {
  std::string link{"base_laser_link"};
  int num_beams{640};
  double angle_min{-2.2689}, angle_max{2.2689};  ///< [rad] of the first and the last beam
  double range_min{0.08}, range_max{10.0};       ///< [m]
  double noise{0.005};                           ///< [m] sd of each range
};

/// Ranges [m] in the order of the angles: infinite where nothing is within range_max, and what is
/// nearer than range_min as range_min. The robot does not see itself. Beams leave from the true
/// pose of the link, leaning included, so that a beam may end on the floor.
/// @pre the robot has an upper body (Scene::surroundings); num_beams >= 2
/// @throws base::ConfigError for an unknown link.
std::vector<double> ScanLaser(const RobotSimulator& simulator, const LaserParams& params,
                              base::Rng* rng);

}  // namespace hires::simulation
