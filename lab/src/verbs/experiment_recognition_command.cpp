#include "lab/src/verbs/experiment_recognition_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>

#include "lab/src/verbs/experiment_command.h"
#include "cli/exit_code.h"
#include "cli/outputs.h"
#include "cli/crew_display.h"
#include "cli/report_output.h"
#include "cli/whole_number.h"
#include "reports/text/configuration_hash.h"
#include "lab/src/recognition/recognition_experiment.h"
#include "reports/text/report_json.h"
#include "reports/task/timeline.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/perception/pcd_file.h"
#include "hires/robot/load_robot.h"

namespace hires::lab {

void AddRecognitionVerb(CLI::App* experiment, RecognitionOptions* o) {
  CLI::App* verb = experiment->add_subcommand(
      "recognition",
      "how well things on random tables are recognised, over distance, torso and how much of them "
      "is hidden. Exit codes: 0 all goals are met, 1 bad input, 2 one is missed, undecided or "
      "without a value, as with few tables (some 250 decide where nothing goes wrong)");
  verb->add_option("--tables", o->tables, "how many, default 500; each has 1 to 8 things")
      ->check(cli::NumberBetween(1, 1000000));
  verb->add_option("--farthest", o->farthest,
                   "[m] of the robot's base from the table's middle, at most; default 1.4, for "
                   "which the goals are")
      ->check(cli::NumberBetween(0.9, 6.0));
  verb->add_option("--seed", o->seed, "of the first table; each next one has the next")
      ->check(cli::WholeNumber());
  verb->add_option("--objects", o->objects, "another catalogue of objects (YAML)");
  verb->add_option("--config", o->config, "another file instead of config/recogniser.yaml");
  verb->add_option("--json", o->json, "write the numbers to this file");
  verb->add_option("--clouds", o->clouds,
                   "write each table's cloud to this folder, as table_SEED.pcd: something to try "
                   "`hires recognise` on");
  verb->add_option("--threads", o->threads, "default: one per core; changes no number but times")
      ->check(cli::NumberBetween(1, 256));
  verb->add_flag("--quiet", o->quiet, "no progress bar");
  o->verb = verb;
}

int RunRecognitionVerb(const RecognitionOptions& options, const std::string& package_folder,
                       const std::function<bool()>& cancelled) {
  cli::CheckOutputs({{"--json", options.json}},
                    {{"objects", options.objects}, {"configuration", options.config}});
  if (!options.clouds.empty()) reports::RequireFolder("--clouds", options.clouds);
  RecognitionOrder order;
  order.tables = options.tables;
  order.seed = options.seed;
  order.variety.farthest = options.farthest;
  const auto scene = imagination::ReadSetupConfig(package_folder + "/config/scene.yaml");
  order.robot = robot::LoadAnyRobot(scene.robot);
  order.recogniser = perception::ReadRecogniserConfig(
      options.config.empty() ? package_folder + "/config/recogniser.yaml" : options.config,
      options.objects);
  if (!options.clouds.empty()) {
    order.on_cloud = [&](std::uint64_t seed, const perception::PointCloud& cloud) {
      perception::WritePcd(cloud, fmt::format("{}/table_{}.pcd", options.clouds, seed));
    };
  }
  const std::string files = reports::ConfigurationHash(package_folder);
  const base::Crew crew = cli::MakeCrew(options.threads, options.quiet, cancelled);
  const auto report = TryRecogniser(order, crew);
  if (crew.on_progress) std::cerr << "\r\033[K";
  if (!report) return cli::kExitCancelled;
  std::cout << ReportText(*report) << FilesLine(files);
  if (!options.json.empty()) reports::WriteJson(ToJson(*report), options.json);
  cli::SaySaved({options.json});
  if (MeetsGoals(*report)) return cli::kExitRecommended;
  std::cout << fmt::format("exit code {}, as not all goals are met:\n{}",
                           static_cast<int>(cli::kExitAllFailed),
                           WhyGoalsAreNotMet(*report));
  return cli::kExitAllFailed;
}

}  // namespace hires::lab
