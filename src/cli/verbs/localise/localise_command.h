#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "cli/drive_log.h"

namespace CLI {
class App;
}

namespace hires::cli {

/// What was typed behind `hires localise`.
struct LocaliseOptions {
  DriveOptions drive;
  std::string map, trajectory, config, json;
  std::optional<std::string> initial;  ///< "x y yaw"
  std::uint64_t seed{1};
  bool is_quiet{false};
  CLI::App* verb{nullptr};
};

/// Adds the verb to the program.  @pre `options` outlives `app`.
void AddLocaliseVerb(CLI::App* app, LocaliseOptions* options);

/// Tells where in a map a robot was during a recorded drive.
/// @return kExitRecommended, kExitUndecided where it does not know in the end.
/// @param read_bag  may be empty; then bags are refused.
/// @throws base::ConfigError for bad input.
int RunLocaliseVerb(const LocaliseOptions& options, const std::string& package_folder,
                    const ReadDriveBag& read_bag);

}  // namespace hires::cli
