#pragma once

#include <memory>

#include "cli/verbs/blackboard/blackboard_command.h"

namespace hires_ros {

/// The running node `blackboard`, through its services.
/// @throws hires::base::ConfigError if there is no master, or no Blackboard there.
std::unique_ptr<hires::cli::BlackboardAccess> ConnectBlackboard();

}  // namespace hires_ros
