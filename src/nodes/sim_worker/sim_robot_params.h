#pragma once

#include <cstdint>
#include <string>

#include "hires/control/robot_names.h"
#include "hires/imagination/imagination_setup.h"
#include "sim_robot/sim_robot_sensors.h"

namespace hires_ros {

struct SimRobotParams {
  hires::imagination::SetupConfig setup;
  hires::control::RobotNames names;
  hires::sim_robot::Truth truth;
  std::string scenario;  ///< file; empty: the world's own objects, the robot at `area`
  std::string area{"nearStartArea1"};
  std::uint64_t seed{1};  ///< of the hidden truth and of all noise
  double pace{1.0};       ///< simulated seconds per second; 0: as fast as it can
  bool lockstep{false};   ///< wait for the middle layer at every tick
  bool hold{false};       ///< stand still until `sim_robot/hold` lets go
  /// Say where it is, as a robot with a localisation of its own; else wheels and inertial unit say
  /// what they measure, and `truth` is one WithoutPlace.
  bool tells_place{true};
  hires::sim_robot::SimSensorParams sensors;
};

/// Reads a file like config/sim_robot.yaml; it does not say the names.
/// @throws hires::base::ConfigError.
SimRobotParams ReadSimRobotParams(const std::string& path);

/// The file in ~config (config/sim_robot.yaml where there is none); ~world, ~robot, ~objects,
/// ~uncertainty, ~truth, ~scenario, ~area, ~seed, ~pace, ~lockstep, ~hold and ~tells_place win over
/// it. Names as LoadRobotNames.
/// @throws hires::base::ConfigError.
SimRobotParams LoadSimRobotParams();

}  // namespace hires_ros
