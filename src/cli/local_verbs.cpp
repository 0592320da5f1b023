#include "cli/local_verbs.h"

#include "cli/program.h"
#include "cli/verbs/imagine/imagine_command.h"
#include "cli/verbs/limits/limits_command.h"
#include "cli/verbs/new/new_command.h"

namespace hires::cli {
namespace {

constexpr char kLocalProgram[] = "hires_local";

ReportOptions* ReportOfDoctor(DoctorOptions* options) { return &options->robot.report; }

}  // namespace

void AddImagine(const ImagineBackends& backends, VerbTable* table) {
  table->Add<ImagineOptions>(AddImagineVerb, ReportOf<ImagineOptions>,
                             [backends](const ImagineOptions& options) {
                               return RunImagineVerb(options, backends, IsInterrupted);
                             });
}

void AddLimits(VerbTable* table) {
  table->Add<LimitsOptions>(AddLimitsVerb, nullptr,
                            [folder = table->package_folder()](const LimitsOptions& options) {
                              return RunLimitsVerb(options, folder, IsInterrupted);
                            });
}

void AddList(const TaskLister& tasks, VerbTable* table) {
  table->Add<ListOptions>(
      [with_tasks = bool(tasks)](CLI::App* app, ListOptions* options) {
        AddListVerb(app, with_tasks, options);
      },
      nullptr,
      [folder = table->package_folder(), tasks](const ListOptions& options) {
        return RunListVerb(options, folder, tasks);
      },
      OnSignal::kEnd);
}

void AddNew(VerbTable* table) {
  table->Add<NewOptions>(AddNewVerb, nullptr, RunNewVerb, OnSignal::kEnd);
}

void AddDoctor(const DoctorBackends& backends, VerbTable* table) {
  table->Add<DoctorOptions>(
      AddDoctorVerb, ReportOfDoctor,
      [backends](const DoctorOptions& options) { return RunDoctorVerb(options, backends); },
      OnSignal::kEnd);
}

int RunLocalCommandLine(const std::vector<std::string>& arguments,
                        const std::string& package_folder) {
  const auto add_verbs = [&](CLI::App* app) {
    VerbTable table(app, {CommandOf(kLocalProgram, arguments), package_folder});
    AddImagine({}, &table);
    AddLimits(&table);
    AddList(nullptr, &table);
    AddNew(&table);
    AddDoctor({package_folder, {}, {}}, &table);
    return table.Take();
  };
  return RunProgram(
      {kLocalProgram, "HIRES in one process: imagine an action in physics before doing it",
       add_verbs},
      arguments);
}

}  // namespace hires::cli
