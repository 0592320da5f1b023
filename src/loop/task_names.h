#pragma once

#include <string>

#include "loop/loop_parts.h"
#include "sim_robot/scenario.h"

namespace hires::loop {

/// What becomes of an argument that nothing names and that is like no name.
enum class StrangeArgument { kWarnedOf, kRefused };

/// A name that nothing gives, neither knowledge nor scenario, world, robot, catalogue or domain, is
/// found by the planner only where a condition asks for it; an area to drive to may be none. So a
/// name is refused that was most likely mistyped, and of one that is like nothing a warning is
/// logged: a domain of somebody else may take any word.
/// @param task  as it was typed.
/// @throws base::ConfigError for a task that the domain lacks or takes with other arguments, and
/// for an argument that is spelt like a known name.
void RequireKnownNames(const LoopSetup::Parts& parts, const sim_robot::Scenario& scenario,
                       const std::string& task, StrangeArgument strange);

}  // namespace hires::loop
