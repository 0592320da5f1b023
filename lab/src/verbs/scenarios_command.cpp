#include "lab/src/verbs/scenarios_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "lab/src/verbs/experiment_command.h"
#include "lab/src/verbs/series_to_play.h"
#include "hires/base/error.h"
#include "hires/base/files/named_file.h"
#include "hires/base/log.h"
#include "hires/base/process.h"
#include "hires/base/spelling.h"
#include "hires/base/text.h"
#include "cli/exit_code.h"
#include "cli/crew_display.h"
#include "cli/whole_number.h"
#include "lab/src/series/series_report.h"
#include "hires/knowledge/blackboard_config.h"
#include "hires/knowledge/store.h"

namespace hires::lab {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

void MakeStore(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error && fs::is_directory(folder)) return;
  std::error_code ignored;
  if (fs::exists(folder, ignored)) {
    throw base::ConfigError(fmt::format("--store {}: is a file; name a folder", folder));
  }
  throw base::ConfigError(
      fmt::format("--store {}: the folder cannot be made ({}); check its path and rights", folder,
                  error.message()));
}

std::size_t NumStored(const std::string& folder) {
  return static_cast<std::size_t>(
      std::count_if(fs::directory_iterator(folder), fs::directory_iterator(),
                    [](const auto& entry) { return entry.path().extension() == ".db"; }));
}

/// Plays runs one after the other, and keeps what they leave.
class Runner {
 public:
  Runner(const ScenariosOptions& options, const std::string& package_folder,
         const SeriesToPlay& series, const std::function<bool()>& cancelled)
      : options_(options),
        series_(series),
        cancelled_(cancelled),
        store_(fs::absolute(options.store).lexically_normal().string()),
        ontology_(std::make_shared<const knowledge::Ontology>(knowledge::Ontology::FromFiles(
            knowledge::ReadBlackboardConfig(package_folder + "/config/blackboard.yaml").ontology))),
        journal_(store_ + "/" + series.name() + ".journal", series.setting()) {}

  const std::vector<SeriesRun>& runs() const { return journal_.runs(); }

  /// @return false when cancelled.
  bool PlayAll() {
    const double begin = base::SteadyNow();
    const int first = static_cast<int>(runs().size());
    if (first > 0 && !options_.quiet) {
      std::cerr << fmt::format("{} {} played before and {} kept\n",
                               base::Counted(runs().size(), "run"), first == 1 ? "was" : "were",
                               first == 1 ? "is" : "are");
    }
    for (int run = first + 1; run <= options_.runs; ++run) {
      if (!PlayOne(run)) return false;
      std::cout << RunSummary(runs().back()) << '\n' << std::flush;
      if (options_.quiet) continue;
      const double fraction = static_cast<double>(run - first) / (options_.runs - first);
      std::cerr << cli::ProgressText(fraction, base::SteadyNow() - begin) << std::endl;
    }
    return true;
  }

 private:
  bool PlayOne(int number) {
    SeriesRun run = series_.Expected(number);
    const std::string name = fmt::format("{}_{:03}", series_.name(), number);
    const std::string folder = store_ + "/" + name;
    fs::remove_all(folder);  // of a try that was interrupted
    fs::create_directories(folder);
    const ScenarioOrder order = series_.Prepare(run, folder);
    Announce(number, order);
    WarnOfOverlaps(run);
    if (!PlayTries(order, &run)) return false;
    Keep(name, order, &run);
    journal_.Append(run);
    return true;
  }

  void Announce(int number, const ScenarioOrder& order) const {
    if (options_.quiet) return;
    std::cerr << fmt::format("run {} of {}: {}\n", number, options_.runs, order.folder);
    if (options_.player.is_graph) return;
    std::vector<std::string> words = AchieveWords(order, options_.player.threads);
    words.resize(words.size() - 4);  // without the files that are there
    words.insert(words.begin(), "hires");
    std::cerr << "  " << cli::CommandText(words) << '\n';
  }

  void WarnOfOverlaps(const SeriesRun& run) const {
    for (const Overlap& overlap : series_.OverlapsOf(run)) {
      base::Log(base::LogLevel::kWarn, fmt::format("run {}: {} begins in {}, or touches it",
                                                   run.run, overlap.thing, overlap.other));
    }
  }

  /// @return false when cancelled.
  bool PlayTries(const ScenarioOrder& order, SeriesRun* run) {
    for (int attempt = 0; attempt <= options_.restarts; ++attempt) {
      const TryEnd end = PlayTry(order, options_.player, cancelled_);
      if (end.is_cancelled) return false;
      run->outcome = ToString(SeriesOutcome::kBroken);
      run->cause = end.broken;
      if (end.broken.empty()) TakeResult(order, run);
      if (run->outcome != ToString(SeriesOutcome::kBroken)) return true;
      run->broken_tries.push_back(run->cause);
      const bool is_last = attempt == options_.restarts;
      if (!options_.quiet) {
        std::cerr << fmt::format("run {} broke down: {}{}\n", run->run, run->cause,
                                 is_last ? "" : "; it is started again");
      }
    }
    return true;
  }

  static void TakeResult(const ScenarioOrder& order, SeriesRun* run) {
    const std::string path = ResultOf(order);
    TakeAchieveReport(ordered_json::parse(base::ReadTextFile(path), nullptr, false),
                                  path, run);
  }

  /// The episode goes among the others; that of a run that broke stays in the run's folder.
  void Keep(const std::string& name, const ScenarioOrder& order, SeriesRun* run) const {
    std::error_code error;
    const bool is_broken = run->outcome == ToString(SeriesOutcome::kBroken);
    if (is_broken || !fs::exists(StoreOf(order), error)) return;
    {
      // Not only to be read: what is in its log yet becomes part of the file.
      const knowledge::Store store(StoreOf(order), ontology_);
      TakeBlackboard(store, run);
    }
    fs::rename(StoreOf(order), store_ + "/" + name + ".db");
    run->episode = name;
  }

  const ScenariosOptions& options_;
  const SeriesToPlay& series_;
  const std::function<bool()>& cancelled_;
  const std::string store_;
  const std::shared_ptr<const knowledge::Ontology> ontology_;
  SeriesJournal journal_;
};

void CheckOutputs(const ScenariosOptions& options) {
  cli::CheckReport(options.report, {}, {{"--csv", options.csv}});
  MakeStore(options.store);
}

int ExitCodeOfRuns(const std::vector<SeriesRun>& runs) {
  const auto any = [&](const auto& is) { return std::any_of(runs.begin(), runs.end(), is); };
  const auto has = [](SeriesOutcome outcome) {
    return [word = ToString(outcome)](const SeriesRun& run) { return run.outcome == word; };
  };
  if (any(has(SeriesOutcome::kBroken))) return kExitSomeBroken;
  const bool is_done =
      std::all_of(runs.begin(), runs.end(), has(SeriesOutcome::kSucceeded));
  return is_done ? kExitAllSucceeded : kExitNotAllSucceeded;
}

void WriteAll(const SeriesReport& report, const ScenariosOptions& options,
              const ordered_json& setting) {
  std::cout << SeriesSummary(report) << FilesLine(setting.at("files")) << std::flush;
  if (!options.csv.empty()) base::ReplaceTextFile(options.csv, SeriesCsv(report));
  cli::ReportOrigin origin;
  origin.verb = "scenarios";
  origin.is_local = !options.player.is_graph;
  origin.inputs = {{"series", options.file}};
  origin.hashes = {{"files", setting.at("files")}, {"inputs", setting.at("inputs")}};
  cli::WriteReport(options.report, origin, ToJson(report));
}

/// Who names a scenario where a series is wanted is told how a series is played with it.
std::string SeriesFile(const std::string& typed, const std::string& package_folder) {
  const std::string folder = package_folder + "/lab/config/series";
  std::vector<std::string> with_scenario;
  for (const std::string& series : base::NamesIn(folder)) {
    for (const std::string& scenario : base::NamesIn(package_folder + "/config/scenarios")) {
      with_scenario.push_back(series + " --scenario " + scenario);
    }
  }
  return base::NamedFile("series", typed, folder, with_scenario);
}

void AddGraphOptions(CLI::App* verb, ScenarioPlayer* player) {
  CLI::Option* graph =
      verb->add_flag("--graph", player->is_graph,
                     "play each run through the graph of nodes, under a master of its own, not in "
                     "one process");
  verb->add_option("--pace", player->pace,
                   "with --graph: simulated seconds of the robot per second, 0: as fast as it can; "
                   "default: 1")
      ->check(cli::NumberBetween(0.0, 1000.0))
      ->needs(graph);
  verb->add_option("--workers", player->workers,
                   "with --graph: simulators that imagine; default: 1")
      ->check(cli::NumberBetween(1, 64))
      ->needs(graph);
}

}  // namespace

void AddScenariosVerb(CLI::App* app, ScenariosOptions* options) {
  CLI::App* verb = app->add_subcommand(
      "scenarios",
      "play a scenario again and again, with things, instructions and sensors changed as a file "
      "says, unattended. Exit codes: 0 all runs succeeded, 1 bad input, 2 all came to an end and "
      "some did not succeed, 3 some broke down in each try, 130 interrupted");
  verb->add_option("file", options->file,
                   "YAML file of !FluentPoseModification and !Scenario documents, or its name in "
                   "lab/config/series")
      ->required();
  verb->add_option("--runs", options->runs, "default: 20")->check(cli::NumberBetween(1, 100000));
  verb->add_option("--seed", options->seed, "of all chance; default: 1")->check(cli::WholeNumber());
  verb->add_option("--order", options->order,
                   "all: through all combinations of choices, and again; drawn: each run draws; "
                   "default: all")
      ->check(CLI::IsMember({"all", "drawn"}));
  verb->add_option("--scenario", options->scenario,
                   "file, or its name in config/scenarios, instead of the file's");
  verb->add_option("--instruction", options->instruction,
                   "'achieve serve_coffee_to_guest guest1', instead of the file's");
  CLI::Option* truth =
      verb->add_option("--truth", options->truth,
                       "file, or its name in config/truths, instead of the file's; default: same");
  verb->add_flag("--ideal", options->is_ideal,
                 "sensors and localisation without any error (config/truths/ideal.yaml)")
      ->excludes(truth);
  verb->add_option("--world", options->world,
                   "SDF world instead of the file's or config/scene.yaml's");
  verb->add_option(
      "--store", options->store,
      "folder for episodes, files of the runs and the journal; the same command goes on "
      "with what is there; default: hires_scenarios");
  verb->add_option("--restarts", options->restarts, "of a run that broke down; default: 1")
      ->check(cli::NumberBetween(0, 100));
  verb->add_option("--hang-after", options->player.hang_after,
                   "[s] without progress, after which a run is taken to hang; default: 300")
      ->check(cli::NumberBetween(0.1, 1e6));
  verb->add_option("--threads", options->player.threads,
                   "that play rollouts; changes no number; default: 2")
      ->check(cli::NumberBetween(1, 256));
  AddGraphOptions(verb, &options->player);
  verb->add_option("--json", options->report.json, "write everything to this file, for machines");
  verb->add_option("--csv", options->csv, "write one line per run to this file");
  verb->add_flag("--quiet", options->quiet, "no progress");
  options->verb = verb;
}

int RunScenariosVerb(const ScenariosOptions& typed, const std::string& package_folder,
                     bool can_play_graph, const std::function<bool()>& cancelled) {
  ScenariosOptions options = typed;
  if (options.player.is_graph && !can_play_graph) {
    throw base::ConfigError(
        "--graph: this build has no ROS nodes to start; build with ROS, or leave it out");
  }
  options.file = SeriesFile(typed.file, package_folder);
  SeriesToPlay series(options, package_folder);
  series.Check();
  CheckOutputs(options);
  Runner runner(options, package_folder, series, cancelled);
  if (!runner.PlayAll()) {
    std::cerr << fmt::format("{} of {} {} kept in {}; the same command goes on with them\n",
                             runner.runs().size(),
                             base::Counted(static_cast<std::size_t>(options.runs), "run"),
                             options.runs == 1 ? "is" : "are", options.store);
    return cli::kExitCancelled;
  }
  SeriesReport report;
  report.series = series.series();
  report.runs.assign(runner.runs().begin(), runner.runs().begin() + options.runs);
  report.stored = NumStored(options.store);
  report.repository = options.store;
  WriteAll(report, options, series.setting());
  return ExitCodeOfRuns(report.runs);
}

}  // namespace hires::lab
