#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace CLI {
class App;
}

namespace hires::lab {

/// What was typed behind `hires_lab experiment localisation`.
struct PoseErrorOptions {
  std::string drives, output, json;
  int series{4}, held_out{4}, threads{0};
  std::uint64_t seed{101};
  bool quiet{false};
  CLI::App* verb{nullptr};
};

/// Adds `localisation` below the verb `experiment`.  @pre `options` outlives `experiment`.
void AddPoseErrorVerb(CLI::App* experiment, PoseErrorOptions* options);

/// @return kExitRecommended or kExitCancelled.
/// @throws base::ConfigError for bad input, before anything is played, and where nothing can be
/// fitted; no file is written then.
int RunPoseErrorVerb(const PoseErrorOptions& options, const std::string& package_folder,
                     const std::function<bool()>& cancelled);

}  // namespace hires::lab
