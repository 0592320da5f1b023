#include "lab/src/verbs/experiment_decision_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <utility>

#include "lab/src/decision/decision_drive.h"
#include "lab/src/dissertation.h"
#include "lab/src/verbs/experiment_command.h"
#include "hires/base/error.h"
#include "base/parallel.h"
#include "hires/base/process.h"
#include "hires/base/text.h"
#include "cli/exit_code.h"
#include "cli/outputs.h"
#include "cli/crew_display.h"
#include "cli/whole_number.h"
#include "reports/text/configuration_hash.h"
#include "lab/src/decision/decision_journal.h"
#include "lab/src/decision/decision_report.h"
#include "reports/text/report_json.h"

namespace hires::lab {
namespace {

std::string JournalPath(const DecisionOptions& options) {
  if (!options.journal.empty()) return options.journal;
  return (options.json.empty() ? "decision" : options.json) + ".journal";
}

/// Who decides, in the order of the table.
std::vector<std::string> ArmsOf(const DecisionOptions& options) {
  if (options.arms.empty()) return AllArms();
  std::vector<std::string> wanted = base::Split(options.arms, ','), arms;
  for (const std::string& arm : wanted) {
    if (HasArm(AllArms(), arm)) continue;
    throw base::ConfigError("--arms: " + base::UnknownName("arm", arm, AllArms()));
  }
  for (const std::string& arm : AllArms()) {
    if (HasArm(wanted, arm)) arms.push_back(arm);
  }
  return arms;
}

/// Everything that all tasks share.
struct DecisionStage {
  DecisionStage(const DecisionOptions& options, const std::string& package_folder)
      : config(ReadDecisionConfig(package_folder + "/lab/config/decision.yaml")),
        setup(package_folder + "/config/loop.yaml"),
        truth(setup.ReadTruth(options.truth)) {
    setting.truth = truth.name;
    setting.seed = options.seed;
    setting.arms = ArmsOf(options);
    setting.files = reports::ConfigurationHash(package_folder);
    setting.default_motion_set = kDissertationMotionSet;
  }

  DecisionConfig config;
  DecisionSetting setting;
  loop::LoopSetup setup;
  sim_robot::Truth truth;
};

DecisionParts PartsOf(const DecisionStage& stage, const std::function<bool()>& cancelled) {
  DecisionParts parts{stage.setup.world(), stage.setup.imagination().scheduler};
  parts.oracle_plays = stage.config.oracle_plays;
  parts.cancelled = cancelled;
  parts.play = [&stage, cancelled](const DecisionTask& task, const std::string& set,
                                   std::uint64_t seed) {
    return PlayDrive(stage.setup, stage.truth, task, set, seed, cancelled);
  };
  return parts;
}

DecisionNeeds NeedsOf(const DecisionStage& stage) {
  const std::vector<std::string>& arms = stage.setting.arms;
  return {stage.setting.truth,
          HasArm(arms, kImaginationArm) || HasArm(arms, kDissertationArm),
          HasArm(arms, kOracleArm)};
}

std::vector<DecisionTask> TasksOf(const DecisionStage& stage, const DecisionOptions& options) {
  std::vector<DecisionTask> tasks;
  for (int number = 1; number <= options.runs; ++number) {
    tasks.push_back(DrawTask(stage.config, options.seed, number));
  }
  return tasks;
}

/// How far it got, on one line that is written again and again.
class Shown {
 public:
  Shown(bool quiet, std::size_t all) : quiet_(quiet), all_(all) {}

  void OneMore() {
    if (quiet_) return;
    const std::lock_guard<std::mutex> lock(mutex_);
    const double share = static_cast<double>(++done_) / static_cast<double>(all_);
    std::cerr << '\r' << cli::ProgressText(share, base::SteadyNow() - begin_) << "\033[K" << std::flush;
  }

 private:
  const bool quiet_;
  const std::size_t all_;
  const double begin_{base::SteadyNow()};
  std::mutex mutex_;
  std::size_t done_{0};  // guarded
};

/// @return false when cancelled.
bool PlayAll(const std::vector<DecisionPiece>& pieces, const DecisionStage& stage,
             const DecisionParts& parts, const DecisionOptions& options,
             DecisionJournal* journal) {
  Shown shown(options.quiet, pieces.size());
  base::Crew crew;
  crew.threads = options.threads;
  crew.cancelled = parts.cancelled;
  const auto play = [&](int index, const base::Advance&) {
    const DecisionPiece& piece = pieces[static_cast<std::size_t>(index)];
    if (journal->Play(piece, stage.setting.truth, parts)) shown.OneMore();
  };
  const bool is_whole = base::DoInParallel(static_cast<int>(pieces.size()), 0.0, crew, play);
  if (!options.quiet) std::cerr << "\r\033[K";
  return is_whole;
}

std::string CommandOf(const DecisionOptions& options) {
  return fmt::format("hires_lab experiment decision --truth {} --runs {} --seed {}{} --resume {}",
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
  verb->add_option("--runs", options->runs, "tasks; default: 400")
      ->check(cli::NumberBetween(1, 1000000));
  verb->add_option("--arms", options->arms,
                   "of imagination, always_slow, always_fast, domain_default, dissertation, "
                   "oracle, with commas between; default: all");
  verb->add_option("--seed", options->seed, "of all chance; default: 1")->check(cli::WholeNumber());
  verb->add_option("--threads", options->threads, "that play tasks; changes no number; default: 2")
      ->check(cli::NumberBetween(1, 256));
  verb->add_option(
      "--resume", options->journal,
      "keep what was played in this file, and go on with what is there; default: "
      "beside --json, else decision.journal here. All truths may share one: what was imagined is "
      "the same for them");
  verb->add_option("--json", options->json, "write everything to this file");
  verb->add_flag("--quiet", options->quiet, "no progress");
  options->verb = verb;
}

int RunDecisionVerb(const DecisionOptions& options, const std::string& package_folder,
                    const std::function<bool()>& cancelled) {
  cli::CheckOutputs({{"--resume", JournalPath(options)}, {"--json", options.json}}, {});
  const DecisionStage stage(options, package_folder);
  const DecisionParts parts = PartsOf(stage, cancelled);
  const DecisionNeeds needs = NeedsOf(stage);
  const std::vector<DecisionTask> tasks = TasksOf(stage, options);
  DecisionJournal journal(JournalPath(options), options.seed, stage.setting.files);
  if (!PlayAll(journal.Missing(tasks, needs, parts), stage, parts, options, &journal)) {
    std::cerr << fmt::format(
        "what was played is kept in {}; the same command goes on with it:\n{}\n",
        JournalPath(options), CommandOf(options));
    return cli::kExitCancelled;
  }
  std::vector<DecisionRecord> records;
  for (const DecisionTask& task : tasks) records.push_back(journal.RecordOf(task, needs, parts));
  const DecisionReport report = SumUpDecisions(
      stage.setting, std::move(records), stage.setup.imagination().scheduler.criteria.prices);
  std::cout << DecisionText(report) << FilesLine(report.setting.files);
  if (!options.json.empty()) {
    reports::WriteJson(ToJson(report, CommandOf(options)), options.json);
  }
  return cli::kExitRecommended;
}

}  // namespace hires::lab
