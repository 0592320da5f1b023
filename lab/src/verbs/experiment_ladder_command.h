#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace CLI {
class App;
}

namespace hires::lab {

/// What was typed behind `hires_lab experiment ladder`.
struct LadderOptions {
  std::string json;
  double seconds{90.0};
  int repeats{5}, threads{0};
  std::uint64_t seed{1};
  bool quiet{false};
  CLI::App* verb{nullptr};
};

/// Adds `ladder` below the verb `experiment`.  @pre `options` outlives `experiment`.
void AddLadderVerb(CLI::App* experiment, LadderOptions* options);

/// @return kExitRecommended or kExitCancelled.
/// @throws base::ConfigError for bad input, before anything is measured.
int RunLadderVerb(const LadderOptions& options, const std::string& package_folder,
                  const std::function<bool()>& cancelled);

}  // namespace hires::lab
