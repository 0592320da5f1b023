#pragma once

#include <hires/StepStatus.h>

#include <limits>
#include <optional>

#include "hires/execution/monitor.h"

/// Steps of a plan as messages, and back.
namespace hires_ros {

/// The time of what has not happened yet, in messages.
constexpr double kNever = std::numeric_limits<double>::quiet_NaN();
std::optional<double> MomentOf(double time);  ///< nothing for kNever

hires::StepStatus ToMsg(const hires::execution::StepStatus& status);
hires::execution::StepStatus FromMsg(const hires::StepStatus& message);

}  // namespace hires_ros
