#pragma once

#include "hires/base/param_reader.h"
#include "sim_robot/truth.h"

// How the base's controller differs from what the robot's profile says.
namespace hires::sim_robot {

/// The block `controller` of a truth: for each key its `value` and `source`.
void ReadControllerChanges(base::ParamReader in, Truth* truth);

void ChangeController(const Truth& truth, robot::BaseControllerParams* params);

}  // namespace hires::sim_robot
