#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "cli/drive_log.h"

namespace CLI {
class App;
}

namespace hires::cli {

/// What was typed behind `hires map`.
struct MapOptions {
  DriveOptions drive;
  bool is_driven{false};  ///< by a simulated robot; these are of it alone
  std::string world, map, robot, scene, motion_set{"fast"}, log_output, truth_output;
  std::vector<std::string> areas;
  std::uint64_t seed{1};
  std::string output, trajectory, json;
  double resolution{0.05};  ///< [m]
  double max_range{30.0};   ///< [m]
  bool is_quiet{false};
  CLI::App* verb{nullptr};
};

/// Adds the verb to the program.  @pre `options` outlives `app`.
void AddMapVerb(CLI::App* app, MapOptions* options);

/// Makes a map of a log, and tells where the robot was; or of a drive through a simulated world,
/// and tells how true it is.
/// @param read_bag  may be empty; then bags are refused.
/// @return kExitRecommended, kExitDoubtful (the map is written all the same) or kExitCancelled.
/// @throws base::ConfigError for bad input.
int RunMapVerb(const MapOptions& options, const std::string& package_folder,
               const ReadDriveBag& read_bag, const std::function<bool()>& cancelled);

}  // namespace hires::cli
