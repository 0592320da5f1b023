#pragma once

#include <string>
#include <vector>

namespace hires_ros {

/// The process that plays one run: `hires_lab hypothesis_run ORDER.json RECORD.json FIRST_PORT`.
/// Plays what the first file orders and writes the second one. Runs under a master of its own on
/// FIRST_PORT, its workers on the ports above. SIGTERM, or the end of the process that started it,
/// ends it and its system.
/// @return exit code: 0 if there is a record.
int RunHypothesisProcess(const std::vector<std::string>& words, const std::string& package_folder);

}  // namespace hires_ros
