#include "lab/src/verbs/experiment_hypothesis_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <mutex>
#include <nlohmann/json.hpp>

#include "lab/src/verbs/experiment_command.h"
#include "lab/src/experiment/hypothesis_local.h"
#include "hires/base/error.h"
#include "base/parallel.h"
#include "hires/base/text.h"
#include "cli/exit_code.h"
#include "cli/outputs.h"
#include "cli/crew_display.h"
#include "cli/whole_number.h"
#include "reports/text/configuration_hash.h"
#include "lab/src/experiment/hypothesis_journal.h"
#include "reports/task/timeline.h"

namespace hires::lab {
namespace {

namespace fs = std::filesystem;
using Steady = std::chrono::steady_clock;

std::string JournalPath(const HypothesisOptions& options) {
  if (!options.journal.empty()) return options.journal;
  if (!options.report.json.empty()) return options.report.json + ".journal";
  return "hypothesis_" + options.scenario + ".journal";
}

void RequireFolders(const HypothesisOptions& options) {
  cli::CheckReport(options.report, {},
                   {{"--resume", JournalPath(options)}, {"--csv", options.csv}});
  if (options.logs.empty()) return;
  std::error_code error;
  fs::create_directories(options.logs, error);
  if (error || !fs::is_directory(options.logs)) {
    throw base::ConfigError(
        fmt::format("--logs {}: the folder cannot be made; check its rights", options.logs));
  }
}

/// A task that takes `time_limit` at this pace must fit into a run.
void CheckLimits(const HypothesisGoal& goal, double pace, const std::string& path) {
  if (pace <= 0.0 || goal.start_limit + goal.time_limit / pace <= goal.wall_limit) return;
  throw base::ConfigError(fmt::format(
      "--pace {:g}: {:g} s simulated take {:g} s, with {:g} s to start more than wall_limit, {:g} "
      "s, in {}; choose a higher pace or limit",
      pace, goal.time_limit, goal.time_limit / pace, goal.start_limit, goal.wall_limit, path));
}

HypothesisSetting SettingOf(const HypothesisOptions& options,
                                        const std::string& package_folder) {
  HypothesisSetting setting;
  setting.scenario = options.scenario;
  setting.runs = options.runs;
  setting.seed = options.seed;
  setting.pace = options.is_local ? 0.0 : options.pace;
  setting.workers = options.workers;
  setting.files = reports::ConfigurationHash(package_folder);
  setting.is_local = options.is_local;
  setting.truth = options.truth;
  return setting;
}

std::string CommandOf(const HypothesisOptions& options) {
  const std::string how =
      options.is_local ? fmt::format("--local --truth {}", cli::Quoted(options.truth))
                       : fmt::format("--pace {:g} --workers {}", options.pace, options.workers);
  return fmt::format("hires_lab experiment hypothesis --scenario {} --runs {} --seed {} {} --resume {}",
                     cli::Quoted(options.scenario), options.runs, options.seed, how,
                     cli::Quoted(JournalPath(options)));
}

std::string Arm(bool imagines) { return imagines ? "with" : "without"; }

/// All that the journal lacks, pair after pair.
std::vector<HypothesisOrder> OrdersFor(const HypothesisOptions& options,
                                                   const HypothesisGoal& goal,
                                                   const HypothesisJournal& journal) {
  std::vector<HypothesisOrder> orders;
  for (int run = 1; run <= options.runs; ++run) {
    for (const bool imagines : {true, false}) {
      if (journal.Has(run, imagines)) continue;
      HypothesisOrder order;
      order.scenario = options.scenario;
      order.run = run;
      order.imagines = imagines;
      order.seed = SeedOfRun(options.seed, run);
      order.pace = options.pace;
      order.workers = options.workers;
      order.goal = goal;
      if (!options.logs.empty()) {
        order.folder = fmt::format("{}/run_{:03}_{}", options.logs, run, Arm(imagines));
      }
      orders.push_back(order);
    }
  }
  return orders;
}

/// A record that can be trusted to be of this order, by whichever process it was played.
HypothesisRun Stamped(HypothesisRun record,
                                  const HypothesisOrder& order, double wall_seconds) {
  record.run = order.run;
  record.imagines = order.imagines;
  record.seed = order.seed;
  record.success = record.success && record.is_complete;
  record.wall_seconds = wall_seconds;
  return record;
}

double SecondsSince(Steady::time_point begin) {
  return std::chrono::duration<double>(Steady::now() - begin).count();
}

std::string DoneLine(const HypothesisRun& run, int num_runs) {
  return fmt::format("run {} of {} {} imagination: {}: {}; {:.0f} s simulated, {:.0f} s", run.run,
                     num_runs, Arm(run.imagines), run.outcome,
                     run.is_complete ? run.verdict : run.reason, run.duration, run.wall_seconds);
}

/// Takes in finished runs from several threads, one after the other.
class Keeper {
 public:
  Keeper(std::size_t num_orders, const HypothesisOptions& options,
         HypothesisJournal* journal)
      : num_orders_(num_orders), options_(options), journal_(*journal) {}

  void Take(HypothesisRun record) {
    const std::lock_guard<std::mutex> lock(mutex_);
    journal_.Append(std::move(record));
    if (options_.quiet) return;
    const double fraction = static_cast<double>(++num_done_) / static_cast<double>(num_orders_);
    std::cerr << DoneLine(journal_.runs().back(), options_.runs) << '\n'
              << cli::ProgressText(fraction, SecondsSince(begin_)) << std::endl;
  }

 private:
  const std::size_t num_orders_;
  const HypothesisOptions& options_;
  const Steady::time_point begin_{Steady::now()};
  std::mutex mutex_;
  HypothesisJournal& journal_;  // guarded
  std::size_t num_done_{0};                 // guarded
};

/// @return false when cancelled.
bool PlayOne(const HypothesisOrder& order, const PlayHypothesis& play,
             const std::function<bool()>& cancelled, Keeper* keeper) {
  const auto begin = Steady::now();
  std::optional<HypothesisRun> record;
  if (!cancelled()) record = play(order, cancelled);
  if (record) keeper->Take(Stamped(*std::move(record), order, SecondsSince(begin)));
  return record.has_value();
}

/// A whole system each has the computer to itself; runs in this process share its cores.
/// @return false when cancelled.
bool PlayAll(const std::vector<HypothesisOrder>& orders,
             const HypothesisOptions& options, const PlayHypothesis& play,
             const std::function<bool()>& cancelled, HypothesisJournal* journal) {
  Keeper keeper(orders.size(), options, journal);
  if (!options.is_local) {
    return std::all_of(orders.begin(), orders.end(),
                       [&](const auto& order) { return PlayOne(order, play, cancelled, &keeper); });
  }
  base::Crew crew;
  crew.threads = options.threads;
  crew.cancelled = cancelled;
  return base::DoInParallel(
      static_cast<int>(orders.size()), 0.0, crew, [&](int task, const base::Advance&) {
        PlayOne(orders[static_cast<std::size_t>(task)], play, cancelled, &keeper);
      });
}

cli::ReportOrigin OriginOf(const HypothesisOptions& options, const std::string& goal,
                      const std::string& package_folder) {
  cli::ReportOrigin origin;
  origin.verb = "experiment hypothesis";
  origin.is_local = options.is_local;
  if (!cli::IsWanted(options.report)) return origin;
  origin.inputs = {{"scenario", package_folder + "/config/scenarios/" + options.scenario + ".yaml"},
                   {"what counts", goal}};
  return origin;
}

void Write(const HypothesisReport& report, const HypothesisOptions& options,
           cli::ReportOrigin origin) {
  std::cout << HypothesisText(report) << FilesLine(report.setting.files);
  if (!options.csv.empty()) base::ReplaceTextFile(options.csv, HypothesisCsv(report));
  origin.hashes = {{"files", report.setting.files}};
  cli::WriteReport(options.report, origin, ToJson(report, CommandOf(options)));
}

int Cancelled(const HypothesisJournal& journal, const HypothesisOptions& options) {
  std::cerr << fmt::format(
      "{} of {} runs are kept in {}; the same command goes on with them:\n{}\n",
      journal.runs().size(), 2 * options.runs, JournalPath(options), CommandOf(options));
  return cli::kExitCancelled;
}

}  // namespace

void AddHypothesisVerb(CLI::App* experiment, HypothesisOptions* options) {
  CLI::App* verb = experiment->add_subcommand("hypothesis",
                                              "play a scenario with the whole system, with and "
                                              "without imagination, on equal hidden truths");
  verb->add_option("--scenario", options->scenario, "topple or serve_coffee")->required();
  verb->add_option("--runs", options->runs, "with imagination, and as many without; default: 20")
      ->check(cli::NumberBetween(1, 100000));
  verb->add_option("--pace", options->pace,
                   "simulated seconds of the robot per second, 0: as fast as it can; default: 1")
      ->check(cli::NumberBetween(0.0, 1000.0));
  verb->add_option("--seed", options->seed, "of all chance; default: 1")->check(cli::WholeNumber());
  verb->add_option("--workers", options->workers, "simulators that imagine; default: 1")
      ->check(cli::NumberBetween(1, 64));
  verb->add_option("--resume", options->journal,
                   "keep finished runs in this file, and go on with those that are there; default: "
                   "beside --json, else hypothesis_<scenario>.journal here");
  CLI::Option* local =
      verb->add_flag("--local", options->is_local,
                     "play robot, world and all that plans, imagines and acts in this program, in "
                     "virtual time; needs no node, and the same words give the same bits");
  verb->add_option("--truth", options->truth,
                   "with --local: what robot and world are really like, a name of config/truths or "
                   "a file; default: same, the model of imagination itself")
      ->needs(local);
  verb->add_option("--threads", options->threads,
                   "with --local: that play runs; changes no number; default: 2")
      ->check(cli::NumberBetween(1, 256))
      ->needs(local);
  verb->add_option("--csv", options->csv, "write one line per run to this file");
  cli::AddReportOptions(verb, &options->report);
  verb->add_option("--logs", options->logs, "keep what the system of each run said in this folder");
  verb->add_flag("--quiet", options->quiet, "no progress");
  options->verb = verb;
}

int RunHypothesisVerb(const HypothesisOptions& options, const std::string& package_folder,
                      const PlayHypothesis& play,
                      const std::function<bool()>& cancelled) {
  const std::string path = package_folder + "/lab/config/hypothesis.yaml";
  const HypothesisGoal goal = ReadHypothesisGoal(path, options.scenario);
  if (!options.is_local) CheckLimits(goal, options.pace, path);
  if (!options.is_local && !play) {
    throw base::ConfigError(
        "this build has no ROS nodes to start; build with ROS, source its setup.bash and repeat, "
        "or "
        "play here: --local");
  }
  RequireFolders(options);
  std::optional<loop::LoopSetup> setup;
  if (options.is_local) {
    setup.emplace(package_folder + "/config/loop.yaml");
  }
  HypothesisSetting setting = SettingOf(options, package_folder);
  // An unknown one is refused before anything is played.
  if (setup) setting.truth = setup->ReadTruth(options.truth).name;
  const cli::ReportOrigin origin = OriginOf(options, path, package_folder);
  HypothesisJournal journal(JournalPath(options), setting);
  const auto orders = OrdersFor(options, goal, journal);
  const PlayHypothesis play_locally = [&](const auto& order, const auto& cancel) {
    return PlayHypothesisLocally(*setup, package_folder, options.truth, order, cancel);
  };
  if (!PlayAll(orders, options, setup ? play_locally : play, cancelled, &journal)) {
    return Cancelled(journal, options);
  }
  const HypothesisReport report = SumUpHypothesis(setting, journal.runs());
  Write(report, options, origin);
  return report.with.complete + report.without.complete > 0 ? cli::kExitRecommended : cli::kExitAllFailed;
}

}  // namespace hires::lab
