#pragma once

#include <string>

#include "hires/imagination/rollout.h"
#include "hires/robot/robot_profile.h"
#include "reports/experience/load_follower.h"

namespace hires_ros {

struct ToppleMonitorParams {
  hires::reports::ToppleMonitorConfig config;
  hires::imagination::RolloutParams rollout;  ///< with the thresholds of Eq. 5.1
  hires::robot::Robot robot;
  std::string store;  ///< file of experiences
  std::string run;    ///< what the parts belong to
};

/// From ~config, ~robot, ~store and ~run.
/// @throws hires::base::ConfigError naming parameter, file and key.
ToppleMonitorParams LoadToppleMonitorParams();

}  // namespace hires_ros
