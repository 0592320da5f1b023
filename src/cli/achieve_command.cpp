#include "cli/achieve_command.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/achieve_display.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/evaluation/report_json.h"
#include "hires/evaluation/timeline.h"

namespace hires::cli {
namespace {

constexpr char kScript[] = "/scripts/plot_timeline";

/// Characters a line has on the terminal; 0: standard output is no terminal.
int TerminalWidth() {
  winsize size{};
  if (isatty(STDOUT_FILENO) == 0 || ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0) return 0;
  return size.ws_col > 0 ? size.ws_col : 80;
}

/// Before the robot sets out.
void RequireFolders(const AchieveOptions& options) {
  for (const std::string& path : {options.timeline, options.png, options.json}) {
    if (!path.empty()) evaluation::RequireFolderOf(path);
  }
}

/// The picture is drawn from a CSV file, which stays beside it when no other place was asked for.
std::string CsvPath(const AchieveOptions& options) {
  if (!options.timeline.empty() || options.png.empty()) return options.timeline;
  return std::filesystem::path(options.png).replace_extension(".csv").string();
}

void WriteFiles(const AchieveOptions& options, const std::string& package_folder,
                const evaluation::AchieveReport& report) {
  const std::string csv = CsvPath(options);
  if (!csv.empty())
    evaluation::WriteText(evaluation::TimelineCsv(evaluation::MakeTimeline(report)), csv);
  if (!options.json.empty()) evaluation::WriteJson(ToJson(report), options.json);
  if (!options.png.empty()) evaluation::DrawTimeline(package_folder + kScript, csv, options.png);
}

std::string Plural(std::size_t count, const std::string& what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

void PrintReport(const evaluation::AchieveReport& report) {
  const evaluation::Timeline timeline = evaluation::MakeTimeline(report);
  if (!timeline.bars.empty()) std::cout << '\n' << evaluation::TimelineText(timeline);
  const std::string table = evaluation::ImaginationTable(report);
  if (!table.empty()) std::cout << '\n' << table;
  if (report.outcome == evaluation::AchieveOutcome::kDryRun)
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

int ExitCodeFor(evaluation::AchieveOutcome outcome) {
  switch (outcome) {
    case evaluation::AchieveOutcome::kSucceeded:
    case evaluation::AchieveOutcome::kDryRun:
      return kExitAchieved;
    case evaluation::AchieveOutcome::kNoPlan:
      return kExitNoWay;
    case evaluation::AchieveOutcome::kPreempted:
      return kExitPreempted;
    default:
      return kExitNotAchieved;
  }
}

}  // namespace

void AddAchieveVerb(CLI::App* app, AchieveOptions* options) {
  CLI::App* verb = app->add_subcommand(
      "achieve",
      "have the running robot do a task. Exit codes: 0 done (or planned and imagined, where the "
      "execution monitor has ~dry_run), 1 failed or refused, 2 no plan, 3 preempted");
  verb->add_option("task", options->task, "'serve_coffee_to_guest guest1', or a SHOP2 task network")
      ->required();
  verb->add_option("--imagination", options->imagination,
                   "domain: as the domain says; thesis: the default also where all alternatives "
                   "fail; off; "
                   "default: as the execution monitor is configured")
      ->check(CLI::IsMember({"domain", "thesis", "off"}));
  verb->add_option("--wait", options->wait,
                   "[s] for the execution monitor to be there; default: 10")
      ->check(CLI::Range(0.0, 1e6));
  verb->add_option("--timeline", options->timeline, "write what was done when to this CSV file");
  verb->add_option("--png", options->png, "and draw it to this file");
  verb->add_option("--json", options->json, "write everything to this file for machines");
  options->verb = verb;
}

int RunAchieveVerb(const AchieveOptions& options, const std::string& package_folder,
                   const evaluation::AchieveRemotely& achieve,
                   const std::function<bool()>& cancelled) {
  if (!achieve) {
    throw base::ConfigError(
        "this build has no ROS nodes to ask; build with ROS and start them (roslaunch hires "
        "topple.launch stay:=true task:='')");
  }
  RequireFolders(options);
  AchieveDisplay display(TerminalWidth());
  const evaluation::AchieveReport report = achieve(
      {base::Join(options.task, " "), options.imagination, options.wait},
      [&](const evaluation::AchieveStatus& status) {
        std::cout << display.Show(status) << std::flush;
      },
      cancelled);
  std::cout << display.Show(report.status);  // its changes may have come with the result alone
  PrintReport(report);
  WriteFiles(options, package_folder, report);
  return ExitCodeFor(report.outcome);
}

}  // namespace hires::cli
