#pragma once

#include <string>

#include "cli/drive_log.h"

namespace CLI {
class App;
}

namespace hires::cli {

/// What was typed behind `hires map`.
struct MapOptions {
  DriveOptions drive;
  std::string output, trajectory, json;
  double resolution{0.05};  ///< [m]
  double max_range{30.0};   ///< [m]
  bool is_quiet{false};
  CLI::App* verb{nullptr};
};

/// Adds the verb to the program.  @pre `options` outlives `app`.
void AddMapVerb(CLI::App* app, MapOptions* options);

/// Makes a map of a log, and tells where the robot was.
/// @param read_bag  may be empty; then bags are refused.
/// @return kExitRecommended.  @throws base::ConfigError for bad input.
int RunMapVerb(const MapOptions& options, const std::string& package_folder,
               const ReadDriveBag& read_bag);

}  // namespace hires::cli
