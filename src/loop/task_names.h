#pragma once

#include "hires/evaluation/scenario.h"
#include "hires/planning/domain.h"
#include "loop/loop_parts.h"

namespace hires::loop {

/// A name that nothing gives, neither knowledge nor scenario, world, robot, catalogue or domain, is
/// found by the planner only where a condition asks for it; an area to drive to may be none. So a
/// name is refused that was most likely mistyped, and of one that is like nothing a warning is
/// logged: a domain of somebody else may take any word.
/// @param task     as it was typed.
/// @param problem  with the task as it was read.
/// @throws base::ConfigError for an argument that is spelt like a known name.
void RequireKnownArguments(const LoopSetup::Parts& parts, const evaluation::Scenario& scenario,
                           const std::string& task, const planning::Problem& problem);

}  // namespace hires::loop
