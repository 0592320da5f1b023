#include "cli/experiment_decision_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>

#include "cli/experiment_command.h"
#include "hires/base/error.h"
#include "hires/base/process.h"
#include "hires/base/text.h"
#include "hires/cli/command_line.h"
#include "hires/evaluation/decision_report.h"
#include "hires/evaluation/experiment_parallel.h"
#include "hires/evaluation/report_json.h"
#include "hires/evaluation/run_journal.h"
#include "hires/loop/action_loop.h"

namespace hires::cli {
namespace {

using evaluation::DecisionRecord;
using evaluation::DecisionTask;
using nlohmann::ordered_json;

constexpr char kKind[] = "hires decision 1";
constexpr char kOperator[] = "move_base_param";
constexpr char kParameter[] = "motion_set";

std::string JournalPath(const DecisionOptions& options) {
  if (!options.journal.empty()) return options.journal;
  return (options.json.empty() ? "decision_" + options.truth : options.json) + ".journal";
}

/// Who decides, in the order of the table.
std::vector<std::string> ArmsOf(const DecisionOptions& options) {
  if (options.arms.empty()) return evaluation::AllArms();
  std::vector<std::string> wanted = base::Split(options.arms, ','), arms;
  for (const std::string& arm : wanted) {
    if (std::count(evaluation::AllArms().begin(), evaluation::AllArms().end(), arm) > 0) continue;
    throw base::ConfigError("--arms: " + base::UnknownName("arm", arm, evaluation::AllArms()));
  }
  for (const std::string& arm : evaluation::AllArms()) {
    if (std::count(wanted.begin(), wanted.end(), arm) > 0) arms.push_back(arm);
  }
  return arms;
}

bool Has(const std::vector<std::string>& arms, const char* arm) {
  return std::count(arms.begin(), arms.end(), arm) > 0;
}

/// What the domain has its robot drive with when imagination has no answer.
std::string DefaultMotionSet(const planning::OperatorData& operators) {
  const auto& imagine = planning::EntryOf(operators, kOperator).imagine;
  if (imagine && imagine->defaults.count(kParameter) > 0) return imagine->defaults.at(kParameter);
  throw base::ConfigError(
      fmt::format("operator '{}' has no default for '{}'; name one in the "
                  "domain's sidecar",
                  kOperator, kParameter));
}

/// Everything that all tasks share.
struct Stage {
  Stage(const DecisionOptions& options, const std::string& package_folder)
      : config(evaluation::ReadDecisionConfig(package_folder + "/config/decision.yaml")),
        setup(package_folder + "/config/loop.yaml"),
        truth(setup.ReadTruth(options.truth)) {
    setting.truth = truth.name;
    setting.seed = options.seed;
    setting.arms = ArmsOf(options);
    setting.files = HashOfFiles(package_folder);
    setting.default_motion_set = DefaultMotionSet(setup.operators());
  }

  evaluation::DecisionConfig config;
  evaluation::DecisionSetting setting;
  loop::LoopSetup setup;
  evaluation::Truth truth;
};

evaluation::DecisionParts PartsOf(const Stage& stage, const std::function<bool()>& cancelled) {
  const std::vector<std::string>& arms = stage.setting.arms;
  evaluation::DecisionParts parts{stage.setup.world(), stage.setup.imagination().scheduler};
  parts.default_motion_set = stage.setting.default_motion_set;
  parts.oracle_plays = Has(arms, evaluation::kOracleArm) ? stage.config.oracle_plays : 0;
  parts.imagines = Has(arms, evaluation::kImaginationArm);
  parts.is_dissertation = Has(arms, evaluation::kDissertationArm);
  parts.cancelled = cancelled;
  parts.play = [&stage, cancelled](const DecisionTask& task, const std::string& set,
                                   std::uint64_t seed) {
    return loop::PlayDrive(stage.setup, stage.truth, task, set, seed, cancelled);
  };
  return parts;
}

/// What makes two series the same. How many tasks were asked for is none of it: a series may grow.
ordered_json HeadOf(const Stage& stage) {
  const std::vector<std::string>& arms = stage.setting.arms;
  return {{"journal", kKind},
          {"truth", stage.setting.truth},
          {"seed", stage.setting.seed},
          {"imagination", Has(arms, evaluation::kImaginationArm)},
          {"dissertation", Has(arms, evaluation::kDissertationArm)},
          {"oracle", Has(arms, evaluation::kOracleArm)},
          {"files", stage.setting.files}};
}

/// The records of a series, taken in from several threads.
class Series {
 public:
  Series(const Stage& stage, const DecisionOptions& options)
      : quiet_(options.quiet),
        runs_(options.runs),
        journal_(JournalPath(options), HeadOf(stage),
                 [this](const ordered_json& json, const std::string& where) {
                   Keep(evaluation::ParseDecisionRecord(json, where));
                 }) {
    num_known_ = records_.size();
  }

  /// Numbers of the tasks that are to be played.
  std::vector<int> Missing() const {
    std::vector<int> missing;
    for (int number = 1; number <= runs_; ++number) {
      if (records_.count(number) == 0) missing.push_back(number);
    }
    return missing;
  }

  /// A record of the same load, route and height, whose oracle may be used.
  std::optional<DecisionRecord> FindCell(const std::string& cell) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = by_cell_.find(cell);
    if (found == by_cell_.end()) return std::nullopt;
    return records_.at(found->second);
  }

  void Take(DecisionRecord record) {
    const std::lock_guard<std::mutex> lock(mutex_);
    journal_.Append(ToJson(record));
    Keep(std::move(record));
    if (quiet_) return;
    const double done = static_cast<double>(records_.size() - num_known_);
    const double all = static_cast<double>(runs_) - static_cast<double>(num_known_);
    std::cerr << '\r' << ProgressText(std::min(1.0, done / all), base::SteadyNow() - begin_)
              << "\033[K" << std::flush;
  }

  std::size_t size() const { return records_.size(); }
  std::vector<DecisionRecord> Wanted() const {
    std::vector<DecisionRecord> wanted;
    for (const auto& [number, record] : records_) {
      if (number <= runs_) wanted.push_back(record);
    }
    return wanted;
  }

 private:
  void Keep(DecisionRecord record) {
    const int number = record.task.number;
    by_cell_.emplace(evaluation::CellOf(record.task), number);
    records_.insert_or_assign(number, std::move(record));
  }

  const bool quiet_;
  const int runs_;
  const double begin_{base::SteadyNow()};
  std::size_t num_known_{0};
  mutable std::mutex mutex_;
  std::map<int, DecisionRecord> records_;  // guarded: by number of the task
  std::map<std::string, int> by_cell_;     // guarded: one of its tasks
  evaluation::RunJournal journal_;         // guarded; last: what is there is told to the others
};

/// @return false when cancelled.
bool PlayAll(const Stage& stage, const DecisionOptions& options,
             const std::function<bool()>& cancelled, Series* series) {
  const std::vector<int> missing = series->Missing();
  const evaluation::DecisionParts parts = PartsOf(stage, cancelled);
  evaluation::Crew crew;
  crew.threads = options.threads;
  crew.cancelled = cancelled;
  return evaluation::DoInParallel(
      static_cast<int>(missing.size()), 0.0, crew, [&](int index, const evaluation::Advance&) {
        const DecisionTask task = evaluation::DrawTask(stage.config, options.seed,
                                                       missing[static_cast<std::size_t>(index)]);
        const auto known = series->FindCell(evaluation::CellOf(task));
        auto record = evaluation::PlayDecision(task, parts, known ? &*known : nullptr);
        if (record) series->Take(*std::move(record));
      });
}

std::string CommandOf(const DecisionOptions& options) {
  return fmt::format("hires experiment decision --truth {} --runs {} --seed {}{} --resume {}",
                     options.truth, options.runs, options.seed,
                     options.arms.empty() ? "" : " --arms " + options.arms, JournalPath(options));
}

}  // namespace

void AddDecisionVerb(CLI::App* experiment, DecisionOptions* options) {
  CLI::App* verb = experiment->add_subcommand(
      "decision",
      "what deciding is worth: random drives with a load, the same ones for all who decide, and "
      "how well imagination's predictions fit what happens");
  verb->add_option("--truth", options->truth,
                   "what robot and world are really like, a name of config/truths or a file; "
                   "default: same, the model of imagination itself");
  verb->add_option("--runs", options->runs, "tasks; default: 400")->check(CLI::Range(1, 1000000));
  verb->add_option("--arms", options->arms,
                   "of imagination, always_slow, always_fast, domain_default, dissertation, "
                   "oracle, with commas between; default: all");
  verb->add_option("--seed", options->seed, "of all chance; default: 1")
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--threads", options->threads, "that play tasks; changes no number; default: 2")
      ->check(CLI::Range(1, 256));
  verb->add_option(
      "--resume", options->journal,
      "keep finished tasks in this file, and go on with those that are there; default: "
      "beside --json, else decision_<truth>.journal here");
  verb->add_option("--json", options->json, "write everything to this file");
  verb->add_flag("--quiet", options->quiet, "no progress");
  options->verb = verb;
}

int RunDecisionVerb(const DecisionOptions& options, const std::string& package_folder,
                    const std::function<bool()>& cancelled) {
  for (const std::string& path : {JournalPath(options), options.json}) {
    if (!path.empty()) evaluation::RequireFolderOf(path);
  }
  const Stage stage(options, package_folder);
  Series series(stage, options);
  const bool is_whole = PlayAll(stage, options, cancelled, &series);
  if (!options.quiet) std::cerr << "\r\033[K";
  if (!is_whole) {
    std::cerr << fmt::format("{} tasks are kept in {}; the same command goes on with them:\n{}\n",
                             series.size(), JournalPath(options), CommandOf(options));
    return kExitCancelled;
  }
  const evaluation::DecisionReport report = evaluation::SumUpDecisions(
      stage.setting, series.Wanted(), stage.setup.imagination().scheduler.criteria.prices);
  std::cout << evaluation::DecisionText(report);
  if (!options.json.empty()) {
    evaluation::WriteJson(ToJson(report, CommandOf(options)), options.json);
  }
  return kExitRecommended;
}

}  // namespace hires::cli
