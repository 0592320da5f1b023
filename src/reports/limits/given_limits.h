#pragma once

#include <map>
#include <string>
#include <vector>

namespace hires::reports {

/// Limits that a navigation file sets, and which of its keys say so.
struct GivenLimits {
  /// speed [m/s], acceleration, deceleration [m/s^2], turning [rad/s], angular_acceleration
  /// [rad/s^2]; what the file lacks is not in it.
  std::map<std::string, double> values;
  std::vector<std::string> used;  ///< "DWAPlannerROS: max_vel_x, acc_lim_x"
  std::vector<std::string>
      unused;  ///< the same, of unknown keys and of limits that others override
};

/// Reads parameters of move_base's DWAPlannerROS, TebLocalPlannerROS or TrajectoryPlannerROS (ROS
/// 1), or of Nav2's velocity_smoother and DWB controller (ROS 2, below ros__parameters). ROS 1 keys
/// override Nav2's, the velocity smoother, which is last in Nav2's chain, overrides the controller;
/// of several sections of one kind the first counts. Without a limit of braking (DWA) the one of
/// acceleration counts.
/// @param is_omnidirectional  of the base: limits of x and y then add up to the diagonal.
/// @throws base::ConfigError naming file and lines of all errors: no such limits in it, values that
/// are no numbers, or limits below 0.01.
GivenLimits ReadGivenLimits(const std::string& path, bool is_omnidirectional);

}  // namespace hires::reports
