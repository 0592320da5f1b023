#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace CLI {
class App;
}

namespace hires::lab {

/// What was typed behind `hires_lab experiment torso_poses`.
struct TorsoPosesOptions {
  std::string config, json, stand, area;
  int looks{10}, threads{0};
  std::uint64_t seed{1};
  bool quiet{false};
  CLI::App* verb{nullptr};
};

/// Adds `torso_poses` below the verb `experiment`.  @pre `options` outlives `experiment`.
void AddTorsoPosesVerb(CLI::App* experiment, TorsoPosesOptions* options);

/// @return kExitRecommended, kExitCancelled.  @throws base::ConfigError for bad input, before
/// anything is played.
int RunTorsoPosesVerb(const TorsoPosesOptions& options, const std::string& package_folder,
                      const std::function<bool()>& cancelled);

}  // namespace hires::lab
