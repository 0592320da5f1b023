#pragma once

#include "hires/base/param_reader.h"
#include "hires/robot/extra_sensors.h"

namespace hires::robot {

/// @throws base::ConfigError naming file and key.
ExtraSensors ReadExtraSensors(base::ParamReader in);

/// Whether links and joint are there and the joint's limits allow the sweep.
/// @throws base::ConfigError likewise.
void CheckExtraSensors(base::ParamReader in, const ExtraSensors& sensors, const RobotModel& model);

}  // namespace hires::robot
