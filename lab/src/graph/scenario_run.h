#pragma once

#include <string>
#include <vector>

namespace hires_ros {

/// The process that plays one run of `hires_lab scenarios --graph`: `hires_lab scenario_run
/// ORDER.json RESULT.json FIRST_PORT`. Starts the graph of nodes under a master of its own on
/// FIRST_PORT, its workers on the ports above, gives the instruction to the execution monitor, and
/// writes what that reports. SIGTERM, or the end of the process that started it, ends it and its
/// graph.
/// @return exit code: 0 if there is a result; 1 if the graph broke down, and standard error says
/// how.
int RunScenarioProcess(const std::vector<std::string>& words, const std::string& package_folder);

}  // namespace hires_ros
