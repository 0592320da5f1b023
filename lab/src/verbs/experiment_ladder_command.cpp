#include "lab/src/dissertation.h"
#include "lab/src/verbs/experiment_ladder_command.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <ctime>
#include <iostream>
#include <nlohmann/json.hpp>

#include "lab/src/verbs/experiment_command.h"
#include "cli/exit_code.h"
#include "cli/outputs.h"
#include "cli/crew_display.h"
#include "cli/whole_number.h"
#include "lab/src/ladder/ladder.h"
#include "reports/text/report_json.h"
#include "loop/task_loop.h"

namespace hires::lab {
namespace {

LadderClocks ClocksOfThisComputer() {
  return {[] {
            const auto now = std::chrono::steady_clock::now().time_since_epoch();
            return std::chrono::duration<double>(now).count();
          },
          [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }};
}

std::optional<double> PlayTopple(const loop::LoopSetup& setup, const std::string& package_folder,
                                 std::uint64_t seed, const std::function<bool()>& cancelled) {
  loop::LoopOrder order;
  order.scenario = package_folder + "/config/scenarios/topple.yaml";
  order.seed = seed;
  order.defaults = kDissertationDefaults;
  const loop::LoopRun run = loop::PlayTask(setup, order, {}, cancelled);
  if (cancelled && cancelled()) return std::nullopt;
  return run.virtual_seconds;
}

}  // namespace

void AddLadderVerb(CLI::App* experiment, LadderOptions* o) {
  CLI::App* verb = experiment->add_subcommand(
      "ladder", "how fast what is simulated: the steps of the dissertation, and ours");
  verb->add_option("--seconds", o->seconds, "about so long, 90 if not said; more is more exact")
      ->check(cli::NumberBetween(1.0, 86400.0));
  verb->add_option("--repeats", o->repeats, "of each measurement, at most; 5 if not said")
      ->check(cli::NumberBetween(2, 1000));
  verb->add_option("--seed", o->seed, "of all that is played")->check(cli::WholeNumber());
  verb->add_option("--json", o->json, "write the numbers to this file");
  verb->add_option("--threads", o->threads, "that count as all cores; default: one per core")
      ->check(cli::NumberBetween(1, 256));
  verb->add_flag("--quiet", o->quiet, "no progress bar");
  o->verb = verb;
}

int RunLadderVerb(const LadderOptions& options, const std::string& package_folder,
                  const std::function<bool()>& cancelled) {
  cli::CheckOutputs({{"--json", options.json}}, {});
  const loop::LoopSetup loop(package_folder + "/config/loop.yaml");
  LadderOrder order;
  order.package_folder = package_folder;
  order.seconds = options.seconds;
  order.repeats = options.repeats;
  order.seed = options.seed;
  order.clocks = ClocksOfThisComputer();
  order.play_task = [&](std::uint64_t seed) {
    return PlayTopple(loop, package_folder, seed, cancelled);
  };
  const base::Crew crew = cli::MakeCrew(options.threads, options.quiet, cancelled);
  const auto report = ClimbLadder(order, crew);
  if (crew.on_progress) std::cerr << "\r\033[K";
  if (!report) return cli::kExitCancelled;
  std::cout << ReportText(*report);
  if (!options.json.empty()) reports::WriteJson(ToJson(*report), options.json);
  return cli::kExitRecommended;
}

}  // namespace hires::lab
