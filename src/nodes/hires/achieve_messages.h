#pragma once

#include <hires/ImaginationStatus.h>

#include "loop/achieve.h"

/// Imaginations of a task as messages, and back.
namespace hires_ros {

hires::ImaginationStatus ToMsg(const hires::loop::ImaginedStep& step);
/// @throws hires::base::ConfigError for an outcome that there is not.
hires::loop::ImaginedStep FromMsg(const hires::ImaginationStatus& message);

}  // namespace hires_ros
