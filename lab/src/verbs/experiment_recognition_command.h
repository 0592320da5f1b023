#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace CLI {
class App;
}

namespace hires::lab {

/// What was typed behind `hires_lab experiment recognition`.
struct RecognitionOptions {
  std::string config, objects, json, clouds;
  int tables{500}, threads{0};
  double farthest{1.4};
  std::uint64_t seed{2000};
  bool quiet{false};
  CLI::App* verb{nullptr};
};

/// Adds `recognition` below the verb `experiment`.  @pre `options` outlives `experiment`.
void AddRecognitionVerb(CLI::App* experiment, RecognitionOptions* options);

/// @return kExitRecommended when all goals are met, kExitAllFailed when one is missed or is not
/// told by so few tables, which a line below says, kExitCancelled.  @throws base::ConfigError for
/// bad input, before anything is played.
int RunRecognitionVerb(const RecognitionOptions& options, const std::string& package_folder,
                       const std::function<bool()>& cancelled);

}  // namespace hires::lab
