#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "cli/report_output.h"
#include "cli/verbs/imagine/imagine_query.h"
#include "cli/verbs/imagine/query_scene.h"
#include "cli/verbs/imagine/save_rollout.h"

namespace hires::cli {

/// What was typed behind `hires imagine`, before it is checked against files.
struct ImagineOptions {
  StartOptions start;
  SaveRolloutOptions save;
  ReportOptions report;
  std::string action, config, scene, world, map, robot, objects, uncertainty, ranking, sensing;
  std::vector<std::string> arguments, action_libraries, areas;
  int rollouts{0}, threads{0};
  std::uint64_t seed{1};
  double deadline{-1.0}, min_success{0.0}, max_regret{-1.0};
  bool play_all{false}, local{false}, quiet{false};
  CLI::App* verb{nullptr};
};

/// Adds the verb to the program.  @pre `options` outlives `app`.
void AddImagineVerb(CLI::App* app, ImagineOptions* options);

/// Plays alternatives of an action, in this process or through running nodes, prints and writes.
/// @return as ExitCodeOf.  @throws base::ConfigError for bad input.
int RunImagineVerb(const ImagineOptions& options, const ImagineBackends& backends,
                   const std::function<bool()>& cancelled);

}  // namespace hires::cli
