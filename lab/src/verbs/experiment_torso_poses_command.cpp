#include "lab/src/verbs/experiment_torso_poses_command.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>

#include "lab/src/verbs/experiment_command.h"
#include "cli/exit_code.h"
#include "cli/outputs.h"
#include "cli/crew_display.h"
#include "cli/whole_number.h"
#include "reports/text/configuration_hash.h"
#include "lab/src/recognition/torso_poses.h"
#include "reports/text/report_json.h"

namespace hires::lab {

void AddTorsoPosesVerb(CLI::App* experiment, TorsoPosesOptions* o) {
  CLI::App* verb = experiment->add_subcommand(
      "torso_poses",
      "from which height and place things on a table are recognised and grasped best");
  verb->add_option("--looks", o->looks, "at each thing from each pose")
      ->check(cli::NumberBetween(1, 100000));
  verb->add_option("--seed", o->seed, "of places, headings and noise")->check(cli::WholeNumber());
  verb->add_option("--stand", o->stand, "area at which the robot stands by default");
  verb->add_option("--area", o->area, "area on which the things stand");
  verb->add_option("--config", o->config, "another file instead of config/recogniser.yaml");
  verb->add_option("--json", o->json, "write the numbers to this file");
  verb->add_option("--threads", o->threads, "default: one per core; changes no number")
      ->check(cli::NumberBetween(1, 256));
  verb->add_flag("--quiet", o->quiet, "no progress bar");
  o->verb = verb;
}

int RunTorsoPosesVerb(const TorsoPosesOptions& options, const std::string& package_folder,
                      const std::function<bool()>& cancelled) {
  cli::CheckOutputs({{"--json", options.json}}, {{"configuration", options.config}});
  const auto scene = imagination::ReadSetupConfig(package_folder + "/config/scene.yaml");
  TorsoPosesOrder order;
  order.recogniser = perception::ReadRecogniserConfig(
      options.config.empty() ? package_folder + "/config/recogniser.yaml" : options.config);
  order.setup = imagination::LoadImaginationSetup(scene);
  if (!options.stand.empty()) order.stand = options.stand;
  if (!options.area.empty()) order.area = options.area;
  order.looks = options.looks;
  order.seed = options.seed;
  const std::string files = reports::ConfigurationHash(package_folder);
  const base::Crew crew = cli::MakeCrew(options.threads, options.quiet, cancelled);
  const auto report = PlayTorsoPoses(order, crew);
  if (crew.on_progress) std::cerr << "\r\033[K";
  if (!report) return cli::kExitCancelled;
  std::cout << ReportText(*report) << FilesLine(files);
  if (!options.json.empty()) reports::WriteJson(ToJson(*report), options.json);
  return cli::kExitRecommended;
}

}  // namespace hires::lab
