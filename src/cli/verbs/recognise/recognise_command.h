#pragma once

#include <string>

namespace CLI {
class App;
}

namespace hires::cli {

/// What was typed behind `hires recognise`.
struct RecogniseOptions {
  std::string cloud, json, labels, objects, config;
  bool is_segmenting{false};  ///< and no more
  CLI::App* verb{nullptr};
};

/// Adds the verb to the program.  @pre `options` outlives `app`.
void AddRecogniseVerb(CLI::App* app, RecogniseOptions* options);

/// Tells what stands on a table in the file of a cloud.
/// @return kExitRecommended, kExitUndecided where no table is seen, or not what is on it.
/// @throws base::ConfigError for bad input.
int RunRecogniseVerb(const RecogniseOptions& options, const std::string& package_folder);

}  // namespace hires::cli
