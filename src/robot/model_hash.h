#pragma once

#include <cstdint>

#include "hires/robot/robot_model.h"

namespace hires::robot {

/// Of all values of the model but its `hash`; meshes count by their triangles, not by their files.
std::uint64_t HashOf(const RobotModel& model);

}  // namespace hires::robot
