#pragma once

#include <cstdint>
#include <string>

namespace CLI {
class App;
}

namespace hires::lab {

/// What was typed behind `hires_lab experiences`.
struct ExperiencesOptions {
  std::string store, csv, json, state, action, run;
  double from{0.0}, to{0.0};
  int episode{-1};
  std::uint64_t seed{1};
  CLI::App* verb{nullptr};
  CLI::App* export_verb{nullptr};
  CLI::App* stats_verb{nullptr};
  CLI::App* analyse_verb{nullptr};
};

/// Adds the verb to the program.  @pre `options` outlives `app`.
void AddExperiencesVerb(CLI::App* app, ExperiencesOptions* options);

/// @return kExitRecommended.  @throws base::ConfigError for bad input.
int RunExperiencesVerb(const ExperiencesOptions& options);

}  // namespace hires::lab
