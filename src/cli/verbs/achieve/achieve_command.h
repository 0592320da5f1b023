#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/report_output.h"
#include "loop/achieve.h"
#include "loop/loop_observer.h"
#include "loop/task_loop.h"

namespace CLI {
class App;
}

namespace hires::cli {

/// Exit codes of `hires achieve`.
enum AchieveExitCode {
  kExitAchieved = 0,     ///< or it was a dry run, which came to its end
  kExitNotAchieved = 1,  ///< it failed, was refused, or the input is bad: the message says why
  kExitNoWay = 2,        ///< there is no plan (left)
  kExitPreempted = 3,    ///< ended on request; the robot stands
};

/// What was typed behind `hires achieve`.
struct AchieveOptions {
  std::vector<std::string> task;  ///< words
  std::string imagination, timeline, record;
  std::vector<std::string> defaults;  ///< `is_local`: "motion_set=fast"
  std::string store;  ///< `is_local`: file for the Blackboard
  ReportOptions report;
  double wait{10.0};    ///< [s] for the execution monitor to be there
  bool is_list{false};  ///< says which tasks there are, and does none
  /// `domain` of the list: empty: the running monitor's, else the restaurant's.
  loop::LoopFiles files;
  std::vector<std::string> areas;  ///< as typed: `is_local`
  bool is_dry_run{false};          ///< planned and imagined alone; `is_local`
  bool is_local{false};            ///< in this process and in virtual time, without any node
  std::string scenario{"topple"};  ///< where the robot and everything is then: file, or its name
  std::string config;              ///< of virtual time; empty: config/loop.yaml
  std::string sensing;             ///< in place of the truth's; empty: as it says
  std::string truth{"same"};       ///< what robot and world are really like: file, or its name
  int seed{1}, threads{2};
  CLI::App* verb{nullptr};
};

/// Adds the verb to the program.  @pre `options` outlives `app`.
void AddAchieveVerb(CLI::App* app, AchieveOptions* options);

/// Has the task done, shows how far it is, and afterwards what was done when.
/// @param achieve  Empty: this program has no execution monitor to ask.
/// @param record   Empty: this program cannot write bags.
/// @return AchieveExitCode.  @throws base::ConfigError for bad input.
int RunAchieveVerb(const AchieveOptions& options, const std::string& package_folder,
                   const loop::AchieveRemotely& achieve, const std::function<bool()>& cancelled,
                   const loop::RecordLoop& record = {});

}  // namespace hires::cli
