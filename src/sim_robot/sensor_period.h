#pragma once

#include <string>

#include "hires/base/param_reader.h"

namespace hires::sim_robot {

/// A period [s] of a sensor that speaks at ticks of `tick` [ms] alone, up to a minute.
/// @throws base::ConfigError for what is no multiple of the tick.
double ReadPeriod(const std::string& key, long tick, base::ParamReader* in);

}  // namespace hires::sim_robot
