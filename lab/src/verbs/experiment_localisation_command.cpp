#include "lab/src/verbs/experiment_localisation_command.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>

#include "lab/src/verbs/experiment_command.h"
#include "hires/base/text.h"
#include "cli/exit_code.h"
#include "cli/outputs.h"
#include "cli/crew_display.h"
#include "cli/whole_number.h"
#include "reports/text/configuration_hash.h"
#include "lab/src/place/pose_error_fit.h"
#include "reports/text/report_json.h"
#include "reports/task/timeline.h"

namespace hires::lab {

void AddPoseErrorVerb(CLI::App* experiment, PoseErrorOptions* o) {
  CLI::App* verb = experiment->add_subcommand(
      "localisation", "how a robot errs that finds its place by itself, fitted for rollouts");
  verb->add_option("--drives", o->drives,
                   "another file instead of lab/config/experiments/legs_world_filter.yaml: its world, "
                   "goals and filters");
  verb->add_option("--series", o->series, "how many, of as many legs as that file says")
      ->check(cli::NumberBetween(1, 10000));
  verb->add_option("--held-out", o->held_out, "how many more, to try the fit on")
      ->check(cli::NumberBetween(1, 10000));
  verb->add_option("--seed", o->seed, "of the first series; each next one has the next")
      ->check(cli::WholeNumber());
  verb->add_option("--output", o->output, "write a file like config/localisation_error.yaml");
  verb->add_option("--json", o->json, "write the numbers to this file");
  verb->add_option("--threads", o->threads, "default: one per core; changes no number")
      ->check(cli::NumberBetween(1, 256));
  verb->add_flag("--quiet", o->quiet, "no progress bar");
  o->verb = verb;
}

int RunPoseErrorVerb(const PoseErrorOptions& options, const std::string& package_folder,
                     const std::function<bool()>& cancelled) {
  cli::CheckOutputs({{"--output", options.output}, {"--json", options.json}},
                    {{"drives", options.drives}});
  ExperimentOverrides overrides;
  overrides.seed = options.seed;
  PoseErrorOrder order;
  order.drives = ReadExperiment(
      options.drives.empty() ? package_folder + "/lab/config/experiments/legs_world_filter.yaml"
                             : options.drives,
      overrides);
  order.series = options.series;
  order.held_out = options.held_out;
  const std::string files = reports::ConfigurationHash(package_folder);
  const base::Crew crew = cli::MakeCrew(options.threads, options.quiet, cancelled);
  const auto report = FitPoseError(order, crew);
  if (crew.on_progress) std::cerr << "\r\033[K";
  if (!report) return cli::kExitCancelled;
  std::cout << ReportText(*report) << FilesLine(files);
  if (!options.json.empty()) reports::WriteJson(ToJson(*report), options.json);
  if (!options.output.empty()) base::ReplaceTextFile(options.output, ToYaml(*report));
  return cli::kExitRecommended;
}

}  // namespace hires::lab
