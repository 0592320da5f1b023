#pragma once

#include <functional>
#include <string>

#include "loop/achieve.h"

namespace hires_ros {

/// Has the running execution monitor (action `achieve`) do a task. When `cancelled`, the task is
/// preempted and its end waited for.
/// @throws hires::base::ConfigError if there is no master or no execution monitor, or it goes away.
hires::loop::AchieveReport AchieveRemotely(const hires::loop::AchieveQuery& query,
                                           const hires::loop::OnAchieveStatus& on_status,
                                           const std::function<bool()>& cancelled);

/// The parameter ~domain of the running execution monitor; "" where there is no master, no monitor,
/// or it was given none.
std::string DomainOfMonitor();

}  // namespace hires_ros
