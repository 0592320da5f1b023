#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hires/imagination/imagination_setup.h"
#include "hires/localisation/robot_log.h"
#include "hires/simulation/self_localisation.h"

namespace hires::sim_robot {

struct MapDriveParams {
  simulation::SelfLocalisationParams senses;  ///< wheels, inertial unit and laser, how they err
  std::string motion_set{"fast"};             ///< of the robot's profile
  std::uint64_t seed{1};                      ///< of what the senses draw
};

/// What a robot recorded that drove through a simulated world so that a map can be made of it, and
/// what was really so.
struct MapDrive {
  /// Odometry of wheels and inertial unit, joined as OdometryFilter does it, at 20 Hz; scans with
  /// all beams of the laser, at 5 Hz.
  localisation::RobotLog log;
  localisation::TimedPath truth;     ///< base in the world, one pose for each scan
  std::vector<std::string> visited;  ///< areas, in turn; it began at the first one
  std::vector<std::string> missed;   ///< "area: failure"
};

/// The robot starts at the first area (by name) to stand at where it touches nothing, goes to the
/// nearest one that it has not been at, and so on, and back to the first. It is told where it is
/// and drives by what is really there, as this is about the map: see SelfLocaliser for robots that
/// find their place. An area that cannot be reached is left out.
/// @param setup  with no uncertainty.
/// @return nothing when cancelled.
/// @throws base::ConfigError for a robot without a base laser, an unknown motion set, and a world
/// that has not two areas which can be driven to.
std::optional<MapDrive> DriveForMap(const imagination::ImaginationSetup& setup,
                                    const MapDriveParams& params, const std::string& task,
                                    const std::function<bool()>& cancelled);

}  // namespace hires::sim_robot
