#include "lab/src/verbs/experiment_detector_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "lab/src/verbs/experiment_command.h"
#include "hires/base/hash.h"
#include "hires/base/text.h"
#include "cli/exit_code.h"
#include "cli/outputs.h"
#include "cli/crew_display.h"
#include "cli/report_output.h"
#include "cli/whole_number.h"
#include "reports/text/configuration_hash.h"
#include "lab/src/recognition/detector_fit.h"
#include "reports/text/report_json.h"
#include "reports/task/timeline.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/robot/load_robot.h"

namespace hires::lab {
namespace {

/// Which file, and what stood in it; not where it lay.
std::string NameAndHash(const std::string& path) {
  base::Hasher hasher;
  hasher.Add(base::ReadTextFile(path, 1u << 20));
  return fmt::format("{}#{:08x}", std::filesystem::path(path).filename().string(),
                     hasher.value() & 0xffffffffu);
}

}  // namespace

void AddDetectorFitVerb(CLI::App* experiment, DetectorFitOptions* o) {
  CLI::App* verb = experiment->add_subcommand(
      "detector", "how the recogniser errs, fitted for the quick detector of rollouts");
  verb->add_option("--tables", o->tables, "how many; each has 1 to 8 things and is looked at twice")
      ->check(cli::NumberBetween(1, 1000000));
  verb->add_option("--held-out", o->held_out, "how many more, to try the fit on")
      ->check(cli::NumberBetween(1, 1000000));
  verb->add_option("--seed", o->seed, "of the first table; each next one has the next")
      ->check(cli::WholeNumber());
  verb->add_option("--objects", o->objects, "another catalogue of objects (YAML)");
  verb->add_option("--config", o->config, "another file instead of config/recogniser.yaml");
  verb->add_option("--output", o->output, "write a file like config/detector.yaml");
  verb->add_option("--json", o->json, "write the numbers to this file");
  verb->add_option("--threads", o->threads, "default: one per core; changes no number")
      ->check(cli::NumberBetween(1, 256));
  verb->add_flag("--quiet", o->quiet, "no progress bar");
  o->verb = verb;
}

int RunDetectorFitVerb(const DetectorFitOptions& options, const std::string& package_folder,
                       const std::function<bool()>& cancelled) {
  cli::CheckOutputs({{"--output", options.output}, {"--json", options.json}},
                    {{"objects", options.objects}, {"configuration", options.config}});
  DetectorFitOrder order;
  order.tables = options.tables;
  order.held_out = options.held_out;
  order.seed = options.seed;
  const auto scene = imagination::ReadSetupConfig(package_folder + "/config/scene.yaml");
  order.robot = robot::LoadAnyRobot(scene.robot);
  const std::string config =
      options.config.empty() ? package_folder + "/config/recogniser.yaml" : options.config;
  order.recogniser = perception::ReadRecogniserConfig(config, options.objects);
  const std::string files = reports::ConfigurationHash(package_folder);
  const base::Crew crew = cli::MakeCrew(options.threads, options.quiet, cancelled);
  auto report = FitDetector(order, crew);
  if (crew.on_progress) std::cerr << "\r\033[K";
  if (!report) return cli::kExitCancelled;
  report->objects = NameAndHash(order.recogniser.objects);
  report->recogniser = NameAndHash(config);
  std::cout << ReportText(*report) << FilesLine(files);
  if (!options.json.empty()) reports::WriteJson(ToJson(*report), options.json);
  if (!options.output.empty()) base::ReplaceTextFile(options.output, ToYaml(*report));
  cli::SaySaved({options.json, options.output});
  return cli::kExitRecommended;
}

}  // namespace hires::lab
