#pragma once

#include <vector>

#include "hires/base/rng.h"
#include "hires/geometry/pose.h"
#include "hires/robot/readings.h"
#include "hires/simulation/laser_params.h"
#include "hires/simulation/robot_simulator.h"

namespace hires::simulation {

/// Ranges [m] in the order of the angles: infinite where nothing is within range_max, and what is
/// nearer than range_min as range_min. Beams leave from the true pose of the link, leaning
/// included, so that a beam may end on the floor.
///
/// Of a beam that has a width, eight rays across it are followed. Where they meet a near and a far
/// surface, both echoes come as one if they lie within mixing_depth: their range is the mean,
/// weighted by rays, so that points hang in the air behind edges. Else the stronger echo counts.
/// [Hebert, Krotkov 1992, "3D measurements from imaging laser radars: how good are they?", Image
/// and Vision Computing 10(3), section on mixed pixels; that Hokuyos have them: Cooper, Raquet,
/// Patton 2018, "Range Information Characterization of the Hokuyo UST-20LX LIDAR Sensor", Photonics
/// 5(2):12]
/// @pre the robot has a base laser or an upper body (Scene::surroundings); num_beams >= 2
/// @throws base::ConfigError for an unknown link.
std::vector<double> ScanLaser(const RobotSimulator& simulator, const LaserParams& params,
                              base::Rng* rng);

/// The same for a laser in another pose than its link's in the simulator: one that nods.
std::vector<double> ScanLaserFrom(const geometry::Pose3& X_ML, const RobotSimulator& simulator,
                                  const LaserParams& params, base::Rng* rng);

/// What was measured, as its driver tells it.  @param ranges  [m] of the laser's beams.
robot::ScanReading ReadingOf(const std::vector<double>& ranges, const LaserParams& params);

/// A scan in the plane of the base.
struct LevelScan {
  robot::ScanReading reading;
  geometry::Pose2 X_BL;  ///< the laser in the base
};

/// What the base's laser measures, as its driver tells it; one that hangs upside down is turned
/// over. A level one whose base sways by more than a laser may be tilted is taken as level, as tf
/// takes it.  @pre, @throws  as ScanLaser.
LevelScan ScanLevel(const RobotSimulator& simulator, const LaserParams& params, base::Rng* rng);

/// [rad] of a beam, by its number.
double AngleOf(const LaserParams& params, int beam);

}  // namespace hires::simulation
