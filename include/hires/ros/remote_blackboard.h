#pragma once

#include <memory>

#include "hires/evaluation/blackboard_command.h"

namespace hires_ros {

/// The running node `blackboard`, through its services.
/// @throws hires::base::ConfigError if there is no master, or nobody serves the Blackboard there.
std::unique_ptr<hires::evaluation::BlackboardAccess> ConnectBlackboard();

}  // namespace hires_ros
