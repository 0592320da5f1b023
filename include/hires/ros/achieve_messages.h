#pragma once

#include <hires/ImaginationStatus.h>
#include <hires/StepStatus.h>

#include <limits>

#include "hires/evaluation/achieve.h"
#include "hires/execution/monitor.h"

/// Steps and imaginations of a task as messages, and back.
namespace hires_ros {

/// The time of what has not happened yet, in messages.
constexpr double kNever = std::numeric_limits<double>::quiet_NaN();

hires::StepStatus ToMsg(const hires::execution::StepStatus& status);
hires::execution::StepStatus FromMsg(const hires::StepStatus& message);

hires::ImaginationStatus ToMsg(const hires::evaluation::ImaginedStep& step);
/// @throws hires::base::ConfigError for an outcome that there is not.
hires::evaluation::ImaginedStep FromMsg(const hires::ImaginationStatus& message);

}  // namespace hires_ros
