#include "sim_robot/sensor_period.h"

#include <fmt/format.h>

#include <cmath>

namespace hires::sim_robot {

double ReadPeriod(const std::string& key, long tick, base::ParamReader* in) {
  const double tick_seconds = 0.001 * static_cast<double>(tick);
  const double period = in->Get(key, base::Between(tick_seconds, 60.0));
  const double ticks = period / tick_seconds;
  if (std::abs(ticks - std::round(ticks)) > 1e-6) {
    in->Fail(key, fmt::format("wanted a multiple of {:g} s", tick_seconds));
  }
  return period;
}

}  // namespace hires::sim_robot
