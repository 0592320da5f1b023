#pragma once

#include <optional>
#include <string>

#include "hires/geometry/pose.h"
#include "hires/robot/robot_model.h"

namespace hires::robot {

/// A planar laser that nods: its joint turns evenly from one angle to another, during which one
/// cloud is gathered, and back again, without end.
struct TiltingLaser {
  std::string link;           ///< beams leave in its x-y plane
  std::string joint;          ///< that nods
  double from{0.0}, to{0.0};  ///< [rad]
  double sweep_time{1.0};     ///< [s] from `from` to `to`
  double return_time{0.5};    ///< [s] back
};

/// What a robot has beside the laser and the camera that skills rest on: played by the robot that
/// stands in for a real one, never in rollouts. Key `sensors` of the robot's YAML; all may be
/// missing.
struct ExtraSensors {
  std::string thermal_camera_link;  ///< looks along its x axis; empty: the robot has none
  std::string tray_laser_link;      ///< planar laser just above the tray; empty: none
  std::optional<TiltingLaser> tilting_laser;
  std::string inertial_unit_link;  ///< that integrates its turning to a heading; empty: none
};

/// The joint's angle [rad] and where in the sweep it is.
struct TiltPhase {
  double angle{0.0};
  long sweep{0};           ///< number of the sweep, or of the one after which it goes back
  bool is_sweeping{true};  ///< not going back
};
/// @param time  [s] since it began with its first sweep, >= 0.
TiltPhase PhaseAt(const TiltingLaser& laser, double time);

/// The laser's pose in the link that carries its joint.
/// @throws base::ConfigError for an angle beyond the joint's limits.
geometry::Pose3 X_ParentLaser(const RobotModel& model, const TiltingLaser& laser, double angle);
/// That link's name.
std::string ParentOf(const RobotModel& model, const TiltingLaser& laser);

}  // namespace hires::robot
