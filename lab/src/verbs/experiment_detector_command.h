#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace CLI {
class App;
}

namespace hires::lab {

/// What was typed behind `hires_lab experiment detector`.
struct DetectorFitOptions {
  std::string config, objects, output, json;
  int tables{1000}, held_out{500}, threads{0};
  std::uint64_t seed{5000};
  bool quiet{false};
  CLI::App* verb{nullptr};
};

/// Adds `detector` below the verb `experiment`.  @pre `options` outlives `experiment`.
void AddDetectorFitVerb(CLI::App* experiment, DetectorFitOptions* options);

/// @return kExitRecommended or kExitCancelled.
/// @throws base::ConfigError for bad input, before anything is played, and where nothing can be
/// fitted; no file is written then.
int RunDetectorFitVerb(const DetectorFitOptions& options, const std::string& package_folder,
                       const std::function<bool()>& cancelled);

}  // namespace hires::lab
