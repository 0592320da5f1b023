#include "cli/series/scenarios_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/experiment_command.h"
#include "hires/base/error.h"
#include "hires/base/hash.h"
#include "hires/base/process.h"
#include "hires/base/run_processes.h"
#include "hires/base/text.h"
#include "hires/cli/command_line.h"
#include "hires/cli/whole_number.h"
#include "hires/evaluation/configuration_hash.h"
#include "hires/evaluation/experiment/hypothesis.h"
#include "hires/evaluation/report_json.h"
#include "hires/evaluation/scenario.h"
#include "hires/evaluation/series/series_report.h"
#include "hires/evaluation/truth.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/knowledge/blackboard_config.h"
#include "hires/knowledge/store.h"

namespace hires::cli {
namespace {

namespace fs = std::filesystem;
using evaluation::ScenarioSeries;
using evaluation::SeriesRun;
using evaluation::SeriesStart;
using nlohmann::ordered_json;

constexpr char kIdealTruth[] = "ideal";
constexpr char kDefaultTruth[] = "same";

std::string WholePath(const std::string& path) {
  return path.empty() ? path : fs::absolute(path).lexically_normal().string();
}

void AddFile(base::Hasher* hasher, const std::string& path) {
  hasher->Add(base::ReadTextFile(path));
}

void AddScenario(base::Hasher* hasher, const std::string& path) {
  AddFile(hasher, path);
  for (const std::string& knowledge : evaluation::ReadScenario(path).knowledge) {
    AddFile(hasher, knowledge);
  }
}

/// A series with what its file leaves open filled in.
class Series {
 public:
  Series(const ScenariosOptions& options, const std::string& package_folder)
      : options_(options),
        package_folder_(package_folder),
        series_(evaluation::ReadScenarioSeries(options.file)),
        order_(options.order == "drawn" ? evaluation::SeriesOrder::kDrawn
                                        : evaluation::SeriesOrder::kAll),
        setting_(MakeSetting()) {
    base::Hasher hasher;
    hasher.Add(setting_.dump());
    name_ = series_.name + "_" + base::HexOf(hasher.value()).substr(0, 8);
  }

  const ScenarioSeries& series() const { return series_; }
  const ordered_json& setting() const { return setting_; }
  const std::string& name() const { return name_; }

  /// All that is known of a run before it is played.
  SeriesRun Expected(int number) const {
    SeriesRun run;
    run.run = number;
    run.choices = evaluation::ChoicesOfRun(series_, order_, options_.seed, number);
    run.seed = evaluation::SeedOfRun(options_.seed, number);
    const SeriesStart start = StartOf(run.choices);
    run.instruction = start.instruction;
    run.scenario = fs::path(start.scenario).stem().string();
    run.truth = start.truth;
    return run;
  }

  ScenarioOrder Prepare(const SeriesRun& run, const std::string& folder) const {
    const SeriesStart start = StartOf(run.choices);
    ScenarioOrder order;
    order.task = evaluation::TaskOfInstruction(start.instruction);
    order.files = evaluation::WriteVariant(series_, run.choices,
                                           {start.scenario, order.task, start.world, folder});
    order.truth = start.truth;
    order.folder = folder;
    order.seed = run.seed;
    return order;
  }

  /// Each combination of choices can be made.  @throws base::ConfigError if not.
  void Check() const {
    std::set<std::vector<int>> checked;
    for (int run = 1; run <= options_.runs; ++run) {
      const SeriesRun expected = Expected(run);
      if (!checked.insert(expected.choices).second) continue;
      const base::RunFolder folder("");
      Prepare(expected, folder.path());
      evaluation::FindTruth(expected.truth, package_folder_ + "/config/truths");
    }
  }

 private:
  SeriesStart StartOf(const std::vector<int>& choices) const {
    SeriesStart start = evaluation::StartOfRun(series_, choices);
    if (!options_.scenario.empty()) start.scenario = options_.scenario;
    if (start.scenario.empty()) {
      throw base::ConfigError(options_.file +
                              ": says in no !Scenario document from which Scenario it begins; add "
                              "one, or --scenario NAME");
    }
    start.scenario =
        WholePath(evaluation::ScenarioPath(start.scenario, package_folder_ + "/config/scenarios"));
    if (!options_.instruction.empty()) start.instruction = options_.instruction;
    if (start.instruction.empty()) {
      start.instruction = "achieve " + evaluation::ReadScenario(start.scenario).task;
    }
    if (!options_.truth.empty()) start.truth = options_.truth;
    if (options_.is_ideal) start.truth = kIdealTruth;
    if (start.truth.empty()) start.truth = kDefaultTruth;
    if (!options_.world.empty()) start.world = options_.world;
    if (start.world.empty()) {
      start.world = imagination::ReadSetupConfig(package_folder_ + "/config/scene.yaml").world;
    }
    start.world = WholePath(start.world);
    return start;
  }

  /// Choices with which the starts differ: of each group that `!Scenario` documents name, all.
  std::vector<std::vector<int>> ChoicesOfStarts() const {
    const std::vector<int> first(series_.groups.size(), 0);
    std::vector<std::vector<int>> all{first};
    for (const auto& setting : series_.settings) {
      for (std::size_t g = 0; g < first.size(); ++g) {
        if (series_.groups[g].name != setting.group) continue;
        for (int choice = 1; choice < setting.choices; ++choice) {
          all.push_back(first);
          all.back()[g] = choice;
        }
      }
    }
    return all;
  }

  /// Of all files that runs may begin from: who changes one has another series.
  std::string InputsHash() const {
    base::Hasher hasher;
    AddFile(&hasher, options_.file);
    for (const std::vector<int>& choices : ChoicesOfStarts()) {
      const SeriesStart start = StartOf(choices);
      AddScenario(&hasher, start.scenario);
      AddFile(&hasher, start.world);
      AddFile(&hasher, evaluation::TruthPath(start.truth, package_folder_ + "/config/truths"));
    }
    return base::HexOf(hasher.value());
  }

  ordered_json MakeSetting() const {
    return {{"series", options_.file},
            {"inputs", InputsHash()},
            {"files", evaluation::ConfigurationHash(package_folder_)},
            {"scenario", options_.scenario},
            {"instruction", options_.instruction},
            {"truth", options_.is_ideal ? kIdealTruth : options_.truth},
            {"world", options_.world},
            {"order", options_.order},
            {"seed", options_.seed},
            {"restarts", options_.restarts},
            {"hang_after", options_.player.hang_after},
            {"graph", options_.player.is_graph},
            {"pace", options_.player.is_graph ? options_.player.pace : 0.0},
            {"workers", options_.player.is_graph ? options_.player.workers : 0}};
  }

  const ScenariosOptions& options_;
  const std::string& package_folder_;
  const ScenarioSeries series_;
  const evaluation::SeriesOrder order_;
  const ordered_json setting_;
  std::string name_;
};

void MakeStore(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error && fs::is_directory(folder)) return;
  throw base::ConfigError(
      fmt::format("--store {}: the folder cannot be made; check its rights", folder));
}

std::size_t NumStored(const std::string& folder) {
  return static_cast<std::size_t>(
      std::count_if(fs::directory_iterator(folder), fs::directory_iterator(),
                    [](const auto& entry) { return entry.path().extension() == ".db"; }));
}

/// Plays runs one after the other, and keeps what they leave.
class Runner {
 public:
  Runner(const ScenariosOptions& options, const std::string& package_folder, const Series& series,
         const std::function<bool()>& cancelled)
      : options_(options),
        series_(series),
        cancelled_(cancelled),
        store_(WholePath(options.store)),
        ontology_(std::make_shared<const knowledge::Ontology>(knowledge::Ontology::FromFiles(
            knowledge::ReadBlackboardConfig(package_folder + "/config/blackboard.yaml").ontology))),
        journal_(store_ + "/" + series.name() + ".journal", series.setting()) {}

  const std::vector<SeriesRun>& runs() const { return journal_.runs(); }

  /// @return false when cancelled.
  bool PlayAll() {
    const double begin = base::SteadyNow();
    const int first = static_cast<int>(runs().size());
    if (first > 0 && !options_.quiet) {
      std::cerr << fmt::format("{} runs were played before and are kept\n", first);
    }
    for (int run = first + 1; run <= options_.runs; ++run) {
      if (!PlayOne(run)) return false;
      std::cout << evaluation::RunSummary(runs().back()) << '\n' << std::flush;
      if (options_.quiet) continue;
      const double fraction = static_cast<double>(run - first) / (options_.runs - first);
      std::cerr << ProgressText(fraction, base::SteadyNow() - begin) << std::endl;
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
    std::cerr << "  " << CommandText(words) << '\n';
  }

  /// @return false when cancelled.
  bool PlayTries(const ScenarioOrder& order, SeriesRun* run) {
    for (int attempt = 0; attempt <= options_.restarts; ++attempt) {
      const TryEnd end = PlayTry(order, options_.player, cancelled_);
      if (end.is_cancelled) return false;
      run->outcome = evaluation::ToString(evaluation::SeriesOutcome::kBroken);
      run->cause = end.broken;
      if (end.broken.empty()) TakeResult(order, run);
      if (run->outcome != evaluation::ToString(evaluation::SeriesOutcome::kBroken)) return true;
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
    evaluation::TakeAchieveReport(ordered_json::parse(base::ReadTextFile(path), nullptr, false),
                                  path, run);
  }

  /// The episode goes among the others; that of a run that broke stays in the run's folder.
  void Keep(const std::string& name, const ScenarioOrder& order, SeriesRun* run) const {
    std::error_code error;
    const bool is_broken = run->outcome == evaluation::ToString(evaluation::SeriesOutcome::kBroken);
    if (is_broken || !fs::exists(StoreOf(order), error)) return;
    {
      // Not only to be read: what is in its log yet becomes part of the file.
      const knowledge::Store store(StoreOf(order), ontology_);
      evaluation::TakeBlackboard(store, run);
    }
    fs::rename(StoreOf(order), store_ + "/" + name + ".db");
    run->episode = name;
  }

  const ScenariosOptions& options_;
  const Series& series_;
  const std::function<bool()>& cancelled_;
  const std::string store_;
  const std::shared_ptr<const knowledge::Ontology> ontology_;
  evaluation::SeriesJournal journal_;
};

void CheckOutputs(const ScenariosOptions& options) {
  CheckReport(options.report);
  if (!options.csv.empty()) evaluation::RequireFolderOf(options.csv);
  MakeStore(options.store);
}

int ExitCodeOfRuns(const std::vector<SeriesRun>& runs) {
  const auto any = [&](const auto& is) { return std::any_of(runs.begin(), runs.end(), is); };
  const auto has = [](evaluation::SeriesOutcome outcome) {
    return [word = ToString(outcome)](const SeriesRun& run) { return run.outcome == word; };
  };
  if (any(has(evaluation::SeriesOutcome::kBroken))) return kExitSomeBroken;
  const bool is_done =
      std::all_of(runs.begin(), runs.end(), has(evaluation::SeriesOutcome::kSucceeded));
  return is_done ? kExitAllSucceeded : kExitNotAllSucceeded;
}

void WriteAll(const evaluation::SeriesReport& report, const ScenariosOptions& options,
              const ordered_json& setting) {
  std::cout << evaluation::SeriesSummary(report) << FilesLine(setting.at("files")) << std::flush;
  if (!options.csv.empty()) base::ReplaceTextFile(options.csv, evaluation::SeriesCsv(report));
  ReportOrigin origin;
  origin.verb = "scenarios";
  origin.is_local = !options.player.is_graph;
  origin.inputs = {{"series", options.file}};
  origin.hashes = {{"files", setting.at("files")}, {"inputs", setting.at("inputs")}};
  WriteReport(options.report, origin, ToJson(report));
}

void AddGraphOptions(CLI::App* verb, ScenarioPlayer* player) {
  CLI::Option* graph =
      verb->add_flag("--graph", player->is_graph,
                     "play each run through the graph of nodes, under a master of its own, not in "
                     "one process");
  verb->add_option("--pace", player->pace,
                   "with --graph: simulated seconds of the robot per second, 0: as fast as it can; "
                   "default: 1")
      ->check(NumberBetween(0.0, 1000.0))
      ->needs(graph);
  verb->add_option("--workers", player->workers,
                   "with --graph: simulators that imagine; default: 1")
      ->check(NumberBetween(1, 64))
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
                   "YAML file of !FluentPoseModification and !Scenario documents")
      ->required();
  verb->add_option("--runs", options->runs, "default: 20")->check(NumberBetween(1, 100000));
  verb->add_option("--seed", options->seed, "of all chance; default: 1")->check(WholeNumber());
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
      ->check(NumberBetween(0, 100));
  verb->add_option("--hang-after", options->player.hang_after,
                   "[s] without progress, after which a run is taken to hang; default: 300")
      ->check(NumberBetween(0.1, 1e6));
  verb->add_option("--threads", options->player.threads,
                   "that play rollouts; changes no number; default: 2")
      ->check(NumberBetween(1, 256));
  AddGraphOptions(verb, &options->player);
  verb->add_option("--json", options->report.json, "write everything to this file, for machines");
  verb->add_option("--csv", options->csv, "write one line per run to this file");
  verb->add_flag("--quiet", options->quiet, "no progress");
  options->verb = verb;
}

int RunScenariosVerb(const ScenariosOptions& options, const std::string& package_folder,
                     bool can_play_graph, const std::function<bool()>& cancelled) {
  if (options.player.is_graph && !can_play_graph) {
    throw base::ConfigError(
        "--graph: this build has no ROS nodes to start; build with ROS, or leave it out");
  }
  const Series series(options, package_folder);
  series.Check();
  CheckOutputs(options);
  Runner runner(options, package_folder, series, cancelled);
  if (!runner.PlayAll()) {
    std::cerr << fmt::format("{} of {} runs are kept in {}; the same command goes on with them\n",
                             runner.runs().size(), options.runs, options.store);
    return kExitCancelled;
  }
  evaluation::SeriesReport report;
  report.series = series.series();
  report.runs.assign(runner.runs().begin(), runner.runs().begin() + options.runs);
  report.stored = NumStored(options.store);
  report.repository = options.store;
  WriteAll(report, options, series.setting());
  return ExitCodeOfRuns(report.runs);
}

}  // namespace hires::cli
