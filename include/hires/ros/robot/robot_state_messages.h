#pragma once

#include <hires/RobotState.h>

#include "hires/robot/observation.h"

/// Every float64 survives both ways bit for bit.
namespace hires_ros {

namespace msg = ::hires;

/// The heading travels beside the quaternion, which would round it.
msg::RobotState ToMsg(const hires::robot::RobotState& state);
hires::robot::RobotState FromMsg(const msg::RobotState& state);

}  // namespace hires_ros
