#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/report_output.h"

namespace hires::lab {

/// What was typed behind `hires_lab reproduce`.
struct ReproduceOptions {
  std::vector<std::string> wanted;
  std::string catalogue, results;
  cli::ReportOptions report;
  bool again{false}, is_list{false}, quiet{false};
  CLI::App* verb{nullptr};
};

/// Adds the verb to the program.  @pre `options` outlives `app`.
void AddReproduceVerb(CLI::App* app, ReproduceOptions* options);

/// Plays what is wanted of the dissertation's results and has no answer yet, and judges all.
/// @return kExitRecommended: all was judged, whatever the verdicts; kExitNoWorker: a play failed,
/// so that an item could not be judged; kExitCancelled.  @throws base::ConfigError for bad input.
int RunReproduceVerb(const ReproduceOptions& options, const std::string& package_folder,
                     const std::function<bool()>& cancelled);

}  // namespace hires::lab
