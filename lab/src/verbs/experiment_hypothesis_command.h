#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "cli/report_output.h"
#include "lab/src/experiment/hypothesis.h"
#include "lab/src/experiment/hypothesis_report.h"

namespace CLI {
class App;
}

namespace hires::lab {

/// What was typed behind `hires_lab experiment hypothesis`.
struct HypothesisOptions {
  std::string scenario, journal, csv, logs;
  cli::ReportOptions report;
  int runs{20}, workers{1};
  std::uint64_t seed{1};
  double pace{1.0};
  bool is_local{false};       ///< in this process and in virtual time, without any node
  std::string truth{"same"};  ///< with is_local
  int threads{2};             ///< with is_local: that play runs
  bool quiet{false};
  CLI::App* verb{nullptr};
};

/// Adds `hypothesis` below the verb `experiment`.  @pre `options` outlives `experiment`.
void AddHypothesisVerb(CLI::App* experiment, HypothesisOptions* options);

/// Plays what the journal does not have yet, prints, writes.
/// @param play  Empty: this program cannot start a system. Not needed for what is local.
/// @return kExitRecommended when all runs were played, kExitAllFailed when each of them broke down,
/// kExitCancelled.  @throws base::ConfigError for bad input, before anything is played.
int RunHypothesisVerb(const HypothesisOptions& options, const std::string& package_folder,
                      const PlayHypothesis& play,
                      const std::function<bool()>& cancelled);

}  // namespace hires::lab
