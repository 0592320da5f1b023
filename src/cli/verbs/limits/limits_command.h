#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace CLI {
class App;
}

namespace hires::cli {

/// What was typed behind `hires limits`.
struct LimitsOptions {
  std::string object, robot, objects, uncertainty, scene, json, yaml;
  double max_fall{0.01};
  std::uint64_t seed{1};
  int threads{0}, check_truths{0};
  bool quiet{false};
  CLI::App* verb{nullptr};
};

/// Adds the verb to the program.  @pre `options` outlives `app`.
void AddLimitsVerb(CLI::App* app, LimitsOptions* options);

/// Looks for the limits, prints and writes them.
/// @return kExitRecommended or kExitCancelled.  @throws base::ConfigError for bad input.
int RunLimitsVerb(const LimitsOptions& options, const std::string& package_folder,
                  const std::function<bool()>& cancelled);

}  // namespace hires::cli
