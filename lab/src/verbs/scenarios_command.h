#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "cli/report_output.h"
#include "lab/src/series/scenario_play.h"

namespace CLI {
class App;
}

namespace hires::lab {

/// Exit codes of `hires_lab scenarios`.
enum ScenariosExitCode {
  kExitAllSucceeded = 0,
  kExitSeriesBadInput = 1,   ///< the message says what is wrong
  kExitNotAllSucceeded = 2,  ///< all runs came to an end, and some failed or were impossible
  kExitSomeBroken = 3        ///< some run broke down in each of its tries
};                           // and kExitCancelled

/// What was typed behind `hires_lab scenarios`.
struct ScenariosOptions {
  std::string file, scenario, instruction, truth, world, csv;
  std::string store{"hires_scenarios"}, order{"all"};
  cli::ReportOptions report;
  ScenarioPlayer player;
  int runs{20}, restarts{1};
  std::uint64_t seed{1};
  bool is_ideal{false}, quiet{false};
  CLI::App* verb{nullptr};
};

/// Adds the verb to the program.  @pre `options` outlives `app`.
void AddScenariosVerb(CLI::App* app, ScenariosOptions* options);

/// Plays what is not yet in the journal, prints and writes.
/// @param can_play_graph  this program has kScenarioRunVerb.
/// @return ScenariosExitCode, or kExitCancelled.  @throws base::ConfigError for bad input, before
/// anything is played.
int RunScenariosVerb(const ScenariosOptions& options, const std::string& package_folder,
                     bool can_play_graph, const std::function<bool()>& cancelled);

}  // namespace hires::lab
