#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace CLI {
class App;
}

namespace hires::lab {

/// What was typed behind `hires_lab experiment decision`.
struct DecisionOptions {
  std::string truth{"same"}, arms, journal, json;
  int runs{400}, threads{2};
  std::uint64_t seed{1};
  bool quiet{false};
  CLI::App* verb{nullptr};
};

/// Adds `decision` below the verb `experiment`.  @pre `options` outlives `experiment`.
void AddDecisionVerb(CLI::App* experiment, DecisionOptions* options);

/// Plays what the journal does not have yet, prints, writes.
/// @return kExitRecommended when all tasks were played, kExitCancelled.  @throws base::ConfigError
/// for bad input, before anything is played.
int RunDecisionVerb(const DecisionOptions& options, const std::string& package_folder,
                    const std::function<bool()>& cancelled);

}  // namespace hires::lab
