#include "cli/verbs/achieve/achieve_command.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>

#include "cli/outputs.h"
#include "cli/verbs/achieve/achieve_display.h"
#include "cli/verbs/imagine/imagine_start.h"
#include "cli/whole_number.h"
#include "hires/base/error.h"
#include "hires/base/process.h"
#include "hires/base/text.h"
#include "hires/robot/load_robot.h"
#include "reports/task/timeline.h"
#include "reports/text/configuration_hash.h"
#include "sim_robot/scenario.h"
#include "sim_robot/truth.h"

namespace hires::cli {
namespace {

/// Characters a line has on the terminal; 0: standard output is no terminal.
int TerminalWidth() {
  winsize size{};
  if (isatty(STDOUT_FILENO) == 0 || ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0) return 0;
  return size.ws_col > 0 ? size.ws_col : 80;
}

void RequireRecorder(const AchieveOptions& options, const loop::RecordLoop& record) {
  if (options.record.empty()) return;
  if (!options.is_local) {
    throw base::ConfigError(
        "--record is for --local; what a running robot does is recorded by `roslaunch hires "
        "episode_recorder.launch record:=FOLDER`");
  }
  if (!record) throw base::ConfigError("--record: this build has no ROS to write bags with");
}

std::string ScenarioPath(const AchieveOptions& options, const std::string& package_folder) {
  return sim_robot::ScenarioPath(options.scenario, package_folder + "/config/scenarios");
}

std::string LoopPath(const AchieveOptions& options, const std::string& package_folder) {
  return options.config.empty() ? package_folder + "/config/loop.yaml" : options.config;
}

/// Of what is played here; running nodes have files of their own.
ReportOrigin OriginOf(const AchieveOptions& options, const std::string& package_folder) {
  ReportOrigin origin;
  origin.verb = "achieve";
  origin.is_local = options.is_local;
  if (!options.is_local) return origin;
  origin.inputs = {{"scenario", ScenarioPath(options, package_folder)},
                   {"virtual time", LoopPath(options, package_folder)},
                   {"world", options.files.world},
                   {"map", options.files.map},
                   {"robot", robot::FileOfRobot(options.files.robot)},
                   {"objects", options.files.objects},
                   {"domain", options.files.domain},
                   {"operators", options.files.operators}};
  for (const std::string& file : AreaFilesOf(options.areas))
    origin.inputs.push_back({"areas", file});
  origin.hashes = {{"files", reports::ConfigurationHash(package_folder)}};
  return origin;
}

/// Before the robot sets out.
void RequireOutputs(const AchieveOptions& options, const ReportOrigin& origin) {
  std::vector<VerbFile> inputs;
  for (const ReportInput& input : origin.inputs) inputs.push_back({input.what, input.path});
  inputs.push_back(PictureFile(options.files.map));
  inputs.push_back({"truth", options.truth});
  CheckReport(
      options.report, inputs,
      {{"--timeline", options.timeline}, {"--record", options.record}, {"--store", options.store}});
}

/// How things really stand in the end, and what the robot touched: no robot knows it.
nlohmann::ordered_json EndOf(const loop::LoopRun& run) {
  nlohmann::ordered_json things = nlohmann::ordered_json::object();
  for (const auto& [name, fate] : run.truth.objects) {
    const Eigen::Vector3d& p = fate.X_MO.translation;
    things[name] = {{"position", {p.x(), p.y(), p.z()}},  // [m] in the map
                    {"stands", fate.stands},
                    {"held_by", fate.attached_to},
                    {"falls", fate.falls}};
  }
  return {{"virtual_seconds", run.virtual_seconds},
          {"touched", run.truth.contact},
          {"objects", things}};
}

/// @param local  what was played here, if it was.
void WriteFiles(const AchieveOptions& options, const ReportOrigin& origin,
                const loop::AchieveReport& report, const std::optional<loop::LoopRun>& local) {
  if (!options.timeline.empty()) {
    const std::string csv = reports::TimelineCsv(reports::MakeTimeline(report));
    base::ReplaceTextFile(options.timeline, csv);
  }
  nlohmann::ordered_json json = reports::ToJson(report);
  if (local) {
    json["truth"] = local->truth_name;
    json["in_truth"] = EndOf(*local);
  }
  json["seed"] = local ? nlohmann::ordered_json(options.seed) : nullptr;
  WriteReport(options.report, origin, json);
}

std::string Plural(std::size_t count, const std::string& what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

/// @param is_dry_run  as it was asked for here; what its robot could not do has failed.
void PrintReport(const loop::AchieveReport& report, bool is_virtual, bool is_dry_run) {
  const reports::Timeline timeline = reports::MakeTimeline(report);
  if (!timeline.bars.empty()) std::cout << '\n' << reports::TimelineText(timeline);
  const std::string table = reports::ImaginationTable(report, is_virtual);
  if (!table.empty()) std::cout << '\n' << table;
  const bool cannot_do =
      is_dry_run && report.outcome == loop::AchieveOutcome::kFailed && !report.status.steps.empty();
  if (cannot_do || report.outcome == loop::AchieveOutcome::kDryRun)
    std::cout << '\n' << DryRunTable(report.status);
  const std::size_t num_imaginations = report.status.imaginations.size();
  std::cout << fmt::format("\n{}: {}{}\n", report.task, ToString(report.outcome),
                           report.reason.empty() ? "" : ": " + report.reason);
  std::cout << fmt::format("{:.1f} s, {}, {}, {}{}\n", timeline.duration,
                           Plural(timeline.bars.size() - num_imaginations, "step"),
                           Plural(num_imaginations, "imagination"),
                           Plural(static_cast<std::size_t>(report.status.replans), "repair"),
                           report.episode > 0 ? fmt::format(", episode {}", report.episode) : "");
}

loop::LoopRun AchieveLocally(const AchieveOptions& options, const std::string& package_folder,
                             const loop::OnAchieveStatus& on_status,
                             const std::function<bool()>& cancelled,
                             loop::LoopRecording* recording) {
  loop::LoopFiles files = options.files;
  files.areas = ReadAreas(options.areas);
  const loop::LoopSetup setup(LoopPath(options, package_folder), files);
  loop::LoopOrder order;
  order.scenario = ScenarioPath(options, package_folder);
  order.task = base::Join(options.task, " ");
  order.imagination = options.imagination;
  order.defaults = base::Join(options.defaults, ",");
  order.dry_run = options.is_dry_run;
  order.truth = options.truth;
  order.sensing = options.sensing;
  order.seed = static_cast<std::uint64_t>(options.seed);
  order.threads = options.threads;
  order.store = options.store;
  if (recording == nullptr) return loop::PlayTask(setup, order, on_status, cancelled);
  const loop::LoopRun run =
      loop::PlayTask(setup, order, on_status, cancelled, recording->observer());
  recording->Finish(run.report);
  return run;
}

/// What is really so in the end, whatever the robot believes.
void PrintTruth(const loop::LoopRun& run, double wall_seconds) {
  std::vector<std::string> fallen;
  for (const auto& [name, fate] : run.truth.objects) {
    if (fate.falls > 0) fallen.push_back(name);
  }
  std::cout << fmt::format(
      "in truth ({}): fallen: {}; the robot touched: {}\n"
      "{:.1f} s of virtual time in {:.1f} s: {:.1f} times real time\n",
      sim_robot::TruthNote(run.truth_name), fallen.empty() ? "nothing" : base::Join(fallen, ", "),
      run.truth.contact.empty() ? "nothing" : run.truth.contact, run.virtual_seconds, wall_seconds,
      run.virtual_seconds / wall_seconds);
}

int ExitCodeFor(loop::AchieveOutcome outcome) {
  switch (outcome) {
    case loop::AchieveOutcome::kSucceeded:
    case loop::AchieveOutcome::kDryRun:
      return kExitAchieved;
    case loop::AchieveOutcome::kNoPlan:
      return kExitNoWay;
    case loop::AchieveOutcome::kPreempted:
      return kExitPreempted;
    default:
      return kExitNotAchieved;
  }
}

void AddFiles(CLI::App* verb, CLI::Option* local, AchieveOptions* achieve) {
  loop::LoopFiles* files = &achieve->files;
  const std::tuple<const char*, std::string*, const char*> options[] = {
      {"--world", &files->world, "with --local: SDF file instead of the configuration's"},
      {"--map", &files->map, "with --local: map_server map whose walls are the world"},
      {"--robot", &files->robot, "with --local: profile, URDF or xacro file, likewise"},
      {"--objects", &files->objects, "with --local: catalogue of objects, likewise"},
      {"--operators", &files->operators,
       "with --local: YAML beside the domain, likewise; default: that of its name"}};
  for (const auto& [name, file, what] : options) verb->add_option(name, *file, what)->needs(local);
  verb->get_option("--map")->excludes(verb->get_option("--world"));
  AddAreaOption(verb, &achieve->areas);
  verb->get_option("--area")->needs(local);
}

/// How a task is played in one process.
void AddLocalOptions(CLI::App* verb, CLI::Option* local, AchieveOptions* options) {
  verb->add_option("--default", options->defaults,
                   "with --local: PARAMETER=VALUE of a step that was not imagined, overrides the "
                   "domain's (motion_set=fast: as in the dissertation)")
      ->needs(local);
  verb->add_flag("--dry-run", options->is_dry_run,
                 "with --local: plan and imagine, print what the robot would do and when, begin "
                 "nothing; of running nodes the execution monitor decides (~dry_run)")
      ->needs(local);
  verb->add_option("--seed", options->seed,
                   "with --local: of the hidden truth, all noise and imagination; default: 1")
      ->check(NumberBetween(0, 2'147'483'647))
      ->needs(local);
  verb->add_option("--truth", options->truth,
                   "with --local: file, or its name in config/truths: what robot and world are "
                   "really like; default: same, imagination's own model")
      ->needs(local);
  verb->add_option("--store", options->store,
                   "with --local: new file that keeps the Blackboard with the episode; see `hires "
                   "blackboard`")
      ->needs(local);
  verb->add_option("--sensing", options->sensing,
                   "with --local: fitted, ideal or pictures (objects are recognised in what the "
                   "depth camera measures), in place of what the truth says")
      ->check(CLI::IsMember({"fitted", "ideal", "pictures"}))
      ->needs(local);
  verb->add_option("--threads", options->threads,
                   "with --local: that play rollouts; the answer is the same for any; default: 2")
      ->check(NumberBetween(1, 256))
      ->needs(local);
}

}  // namespace

void AddAchieveVerb(CLI::App* app, AchieveOptions* options) {
  CLI::App* verb = app->add_subcommand(
      "achieve",
      "have the running robot do a task. Exit codes: 0 done (or planned and imagined, where the "
      "execution monitor has ~dry_run; 1 where a step makes no sense), 1 failed or refused, 2 no "
      "plan, 3 preempted");
  verb->add_option(
      "task", options->task,
      "'serve_coffee_to_guest guest1', or a SHOP2 task network; with --local it may be "
      "left out: the scenario's");
  verb->add_flag("--list", options->is_list,
                 "print the tasks of the domain with their parameters, and do none");
  verb->add_option("--domain", options->files.domain,
                   "SHOP2 or HDDL file; with --list, default: what the running execution monitor "
                   "plans with, else the restaurant's; with --local: to plan with");
  verb->add_option("--imagination", options->imagination,
                   "domain: as the domain says; thesis: the default also where all alternatives "
                   "fail; off; "
                   "default: as the execution monitor is configured")
      ->check(CLI::IsMember({"domain", "thesis", "off"}));
  verb->add_option("--wait", options->wait,
                   "[s] for the master and the execution monitor to be there; default: 10")
      ->check(NumberBetween(0.0, 1e6));
  CLI::Option* local = verb->add_flag(
      "--local", options->is_local,
      "play robot, world and all that plans, imagines and acts in this program, in virtual "
      "time; needs no node. The same words give the same bits");
  verb->add_option("--scenario", options->scenario,
                   "with --local: file, or its name in config/scenarios; default: topple")
      ->needs(local);
  AddFiles(verb, local, options);
  verb->add_option(
          "--config", options->config,
          "with --local: file like config/loop.yaml, its default: what takes how long in "
          "virtual time, and which messages are late or lost; its paths count from its folder")
      ->needs(local);
  AddLocalOptions(verb, local, options);
  verb->add_option("--record", options->record,
                   "with --local: write the episode to this bag, as a robot's would be; see "
                   "`hires replay`");
  verb->add_option("--timeline", options->timeline, "write what was done when to this CSV file");
  verb->add_option("--png", options->report.png, "and draw it to this file");
  AddReportOptions(verb, &options->report);
  options->verb = verb;
}

int RunAchieveVerb(const AchieveOptions& options, const std::string& package_folder,
                   const loop::AchieveRemotely& achieve, const std::function<bool()>& cancelled,
                   const loop::RecordLoop& record) {
  RequireRecorder(options, record);
  if (!options.files.domain.empty() && !options.is_local) {
    throw base::ConfigError(
        "--domain is for --list and --local; the running execution monitor has its own "
        "(closed_loop.launch domain:=FILE)");
  }
  if (!options.is_local && !achieve) {
    throw base::ConfigError(
        "this build has no ROS nodes to ask; build with ROS and start them (roslaunch hires "
        "topple.launch stay:=true task:=none), or play the task here: --local");
  }
  if (!options.is_local && options.task.empty()) {
    throw base::ConfigError("task: nothing came, wanted a task, as 'serve_coffee_to_guest guest1'");
  }
  const ReportOrigin origin = OriginOf(options, package_folder);
  RequireOutputs(options, origin);
  AchieveDisplay display(TerminalWidth());
  const auto show = [&](const loop::AchieveStatus& status) {
    std::cout << display.Show(status) << std::flush;
  };
  const double begun = base::SteadyNow();
  std::optional<loop::LoopRun> local;
  const auto recording = options.record.empty() ? nullptr : record(options.record);
  if (options.is_local) {
    local = AchieveLocally(options, package_folder, show, cancelled, recording.get());
  }
  const loop::AchieveReport report =
      local ? local->report
            : achieve({base::Join(options.task, " "), options.imagination, options.wait}, show,
                      cancelled);
  show(report.status);  // its changes may have come with the result alone
  PrintReport(report, options.is_local, options.is_dry_run);
  if (local) PrintTruth(*local, base::SteadyNow() - begun);
  WriteFiles(options, origin, report, local);
  return ExitCodeFor(report.outcome);
}

}  // namespace hires::cli
