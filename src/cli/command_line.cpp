#include "cli/command_line.h"

#include <CLI/CLI.hpp>
#include <map>
#include <nlohmann/json.hpp>

#include "cli/local_verbs.h"
#include "cli/program.h"
#include "cli/report_output.h"
#include "cli/verb_table.h"
#include "cli/verbs/achieve/achieve_command.h"
#include "cli/verbs/blackboard/blackboard_command.h"
#include "cli/verbs/list/list_command.h"
#include "cli/verbs/list/list_tasks.h"
#include "cli/verbs/localise/localise_command.h"
#include "cli/verbs/map/map_command.h"
#include "cli/verbs/plan/plan_command.h"
#include "cli/verbs/recognise/recognise_command.h"

namespace hires::cli {
namespace {

constexpr char kProgramName[] = "hires";

/// `hires achieve --list`: the tasks of the domain that is, or would be, planned with.
int ListTasks(const AchieveOptions& achieve, const Backends& backends) {
  ListOptions list;
  list.what = "tasks";
  list.domain = achieve.files.domain;
  const bool may_ask = list.domain.empty() && !achieve.is_local && backends.domain_of_monitor;
  if (may_ask) list.domain = backends.domain_of_monitor();
  return RunListVerb(list, backends.package_folder, TasksOf);
}

int Achieve(const AchieveOptions& achieve, const Backends& backends) {
  if (achieve.is_list) return ListTasks(achieve, backends);
  return RunAchieveVerb(achieve, backends.package_folder, backends.achieve_remotely, IsInterrupted,
                        backends.record_loop);
}

std::vector<ProgramVerb> VerbsOf(CLI::App* app, const std::vector<std::string>& arguments,
                                 const Backends& backends) {
  const std::string& folder = backends.package_folder;
  VerbTable table(app, {CommandOf(kProgramName, arguments), folder});
  AddImagine({backends.imagine_remotely, backends.make_rollout_bag}, &table);
  AddLimits(&table);
  table.Add<AchieveOptions>(
      AddAchieveVerb, ReportOf<AchieveOptions>,
      [&](const AchieveOptions& options) { return Achieve(options, backends); });
  table.Add<PlanOptions>(AddPlanVerb, ReportOf<PlanOptions>, [](const PlanOptions& options) {
    return RunPlanVerb(options, IsInterrupted);
  });
  table.Add<BlackboardOptions>(AddBlackboardVerb, nullptr, [&](const BlackboardOptions& options) {
    return RunBlackboardVerb(options, folder, backends.connect_blackboard);
  });
  AddList(TasksOf, &table);
  AddNew(&table);
  table.Add<RecogniseOptions>(
      AddRecogniseVerb, nullptr,
      [&](const RecogniseOptions& options) { return RunRecogniseVerb(options, folder); },
      OnSignal::kEnd);
  table.Add<MapOptions>(AddMapVerb, nullptr, [&](const MapOptions& options) {
    return RunMapVerb(options, folder, backends.read_drive_bag, IsInterrupted);
  });
  table.Add<LocaliseOptions>(
      AddLocaliseVerb, nullptr,
      [&](const LocaliseOptions& options) {
        return RunLocaliseVerb(options, folder, backends.read_drive_bag);
      },
      OnSignal::kEnd);
  table.Add<StoredReportOptions>(
      AddReportVerb, nullptr,
      [&](const StoredReportOptions& options) { return RunReportVerb(options, folder); },
      OnSignal::kEnd);
  AddDoctor({folder, backends.examine_robot, backends.more_checks}, &table);
  for (const Verb& verb : backends.more_verbs) table.AddForeign(verb.name, verb.help, verb.run);
  return table.Take();
}

/// What of this program became `hires_lab`.
std::map<std::string, std::string> MovedToTheLab() {
  std::map<std::string, std::string> moved;
  for (const char* verb : {"experiment", "experiences", "reproduce", "scenarios"}) {
    moved[verb] = std::string("hires_lab ") + verb;
  }
  return moved;
}

}  // namespace

int RunCommandLine(const std::vector<std::string>& arguments, const Backends& backends) {
  const auto add_verbs = [&](CLI::App* app) { return VerbsOf(app, arguments, backends); };
  return RunProgram({kProgramName, "HIRES: imagine an action in physics before doing it", add_verbs,
                     MovedToTheLab()},
                    arguments);
}

}  // namespace hires::cli
