#include "lab/src/verbs/experiment_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <thread>

#include "hires/base/error.h"
#include "hires/base/files/named_file.h"
#include "hires/base/text.h"
#include "cli/exit_code.h"
#include "cli/outputs.h"
#include "cli/crew_display.h"
#include "cli/whole_number.h"
#include "reports/text/configuration_hash.h"
#include "lab/src/experiment/experiment.h"
#include "reports/task/timeline.h"
#include "hires/knowledge/experience.h"

namespace hires::lab {
namespace {

ExperimentOverrides OverridesOf(const ExperimentOptions& options) {
  ExperimentOverrides overrides;
  if (options.verb->count("--seed") > 0) overrides.seed = options.seed;
  if (options.verb->count("--runs") > 0) overrides.runs = options.runs;
  overrides.map = options.map;
  return overrides;
}

void Print(const ExperimentReport& report) {
  std::cout << ReportText(report) << '\n';
  if (report.wall_seconds > 0.0) {
    std::cout << fmt::format("{:.0f} s simulated in {:.1f} s\n", report.findings.simulated_seconds,
                             report.wall_seconds);
  }
}

/// A path, or a name in lab/config/experiments.
std::string ExperimentPath(const ExperimentOptions& options) {
  std::vector<std::string> verbs;
  for (const CLI::App* inner : options.verb->get_subcommands({}))
    verbs.push_back(inner->get_name());
  return base::NamedFile("experiment", options.file,
                         options.report.package_folder + "/lab/config/experiments", verbs);
}

cli::ReportOrigin OriginOf(const ExperimentOptions& options, const std::string& path,
                      const ExperimentConfig& config) {
  const auto file = [](const std::string& path) {
    return path == "scene" || path == "none" || path == "given" ? "" : path;
  };
  cli::ReportOrigin origin;
  origin.verb = "experiment";
  if (!cli::IsWanted(options.report)) return origin;
  origin.inputs = {{"experiment", path},
                   {"scene", config.scene},
                   {"uncertainty", file(config.uncertainty)},
                   {"map", options.map.empty() ? file(config.map) : options.map}};
  return origin;
}

/// A file that begins anew when all is played: experiences of two plays would be told apart by
/// nothing.
std::optional<knowledge::ExperienceStore> ExperiencesOf(
    const ExperimentOptions& options, const ExperimentConfig& config) {
  if (options.experiences.empty()) return std::nullopt;
  if (KindName(config) != "topple_loop") {
    throw base::ConfigError(
        fmt::format("--experiences: {} is of kind {}, which keeps none; wanted topple_loop",
                    options.file, KindName(config)));
  }
  return knowledge::ExperienceStore(options.experiences,
                                    knowledge::ExperienceStore::Mode::kReplace);
}

}  // namespace

std::string FilesLine(const std::string& hash) {
  return fmt::format("files {} (config, worlds, urdf)\n", hash);
}

void AddExperimentVerb(CLI::App* app, ExperimentOptions* options) {
  CLI::App* verb = app->add_subcommand(
      "experiment", "play an experiment of lab/config/experiments and check what it expects");
  verb->add_option("file", options->file,
                   "YAML file of the experiment, or its name in lab/config/experiments");
  verb->add_option("--threads", options->threads, "default: one per core; changes no number")
      ->check(cli::NumberBetween(1, 256));
  verb->add_option("--seed", options->seed, "instead of the file's")->check(cli::WholeNumber());
  verb->add_option("--runs", options->runs,
                   "instead of the file's number of legs, pairs, chains or runs")
      ->check(cli::NumberBetween(1, 1000000));
  verb->add_option("--map", options->map, "map_server YAML: its walls instead of the world's");
  verb->add_option("--csv", options->csv, "write one line per leg, rollout or run to this file");
  cli::AddReportOptions(verb, &options->report);
  verb->add_option("--junit", options->junit,
                   "write what the file expects, and whether it holds, as JUnit XML to this file");
  verb->add_option(
      "--experiences", options->experiences,
      "of topple_loop: keep what the load went through, 20 times a second, in this file, which is "
      "replaced when all is played");
  verb->add_flag("--hashes", options->only_hashes,
                 "print the report's first line alone, and play nothing; without a file: the hash "
                 "of all that series read");
  verb->add_flag("--quiet", options->quiet, "no progress bar");
  options->verb = verb;
  AddHypothesisVerb(verb, &options->hypothesis);
  AddDecisionVerb(verb, &options->decision);
  AddRecognitionVerb(verb, &options->recognition);
  AddDetectorFitVerb(verb, &options->detector);
  AddLadderVerb(verb, &options->ladder);
  AddPoseErrorVerb(verb, &options->pose_error);
  AddTorsoPosesVerb(verb, &options->torso_poses);
}

int RunExperimentVerb(const ExperimentOptions& options, const std::function<bool()>& cancelled) {
  if (options.file.empty() && options.only_hashes) {
    std::cout << FilesLine(reports::ConfigurationHash(options.report.package_folder));
    return cli::kExitRecommended;
  }
  if (options.file.empty()) {
    throw base::ConfigError(
        "experiment: wanted a YAML file or its name in lab/config/experiments, such as paired, or "
        "`hypothesis`, "
        "`decision`, `recognition`, `detector`, `ladder`, `localisation` or `torso_poses` (see "
        "hires "
        "experiment hypothesis --help)");
  }
  const std::string file = ExperimentPath(options);
  const ExperimentConfig config =
      ReadExperiment(file, OverridesOf(options));
  if (options.only_hashes) {
    std::cout << HeadText(UnplayedReport(config));
    return cli::kExitRecommended;
  }
  cli::CheckReport(
      options.report,
      {{"experiment", file}, {"map", options.map}, cli::PictureFile(options.map)},
      {{"--csv", options.csv}, {"--junit", options.junit}, {"--experiences", options.experiences}});
  const cli::ReportOrigin origin = OriginOf(options, file, config);
  const base::Crew crew = cli::MakeCrew(options.threads, options.quiet, cancelled);
  std::optional<knowledge::ExperienceStore> experiences = ExperiencesOf(options, config);
  OnExperience on_experience;
  if (experiences) on_experience = [&](const auto& batch) { experiences->Write(batch); };
  const std::optional<ExperimentReport> report =
      RunExperiment(config, crew, on_experience);
  if (crew.on_progress) std::cerr << "\r\033[K";
  if (!report) return cli::kExitCancelled;
  Print(*report);
  if (experiences) experiences->Finish();
  if (!options.csv.empty()) base::ReplaceTextFile(options.csv, ReportCsv(*report));
  if (!options.junit.empty()) base::ReplaceTextFile(options.junit, JunitXml(*report));
  cli::WriteReport(options.report, origin, ToJson(*report));
  return report->passed() ? cli::kExitRecommended : cli::kExitAllFailed;
}

}  // namespace hires::lab
