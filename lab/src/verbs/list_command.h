#pragma once

#include <string>

namespace CLI {
class App;
}

namespace hires::lab {

/// What was typed behind `hires_lab list`.
struct LabListOptions {
  std::string what, json;
  CLI::App* verb{nullptr};
};

/// Adds the verb to the program.  @pre `options` outlives `app`.
void AddLabListVerb(CLI::App* app, LabListOptions* options);

/// Prints names that the other verbs take.
/// @return kExitRecommended.  @throws base::ConfigError for bad input.
int RunLabListVerb(const LabListOptions& options, const std::string& package_folder);

}  // namespace hires::lab
