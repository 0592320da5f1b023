#include "lab/src/verbs/command_line.h"

#include <CLI/CLI.hpp>

#include "cli/program.h"
#include "cli/verb_table.h"
#include "lab/src/experiment/hypothesis_play.h"
#include "lab/src/verbs/experiences_command.h"
#include "lab/src/verbs/experiment_command.h"
#include "lab/src/verbs/list_command.h"
#include "lab/src/verbs/publish_command.h"
#include "lab/src/verbs/reproduce_command.h"
#include "lab/src/verbs/scenarios_command.h"

namespace hires::lab {
namespace {

constexpr char kProgramName[] = "hires_lab";

int RunAnyExperiment(const ExperimentOptions& options, const LabBackends& backends) {
  const std::string& folder = backends.package_folder;
  if (*options.decision.verb) return RunDecisionVerb(options.decision, folder, cli::IsInterrupted);
  if (*options.pose_error.verb)
    return RunPoseErrorVerb(options.pose_error, folder, cli::IsInterrupted);
  if (*options.detector.verb)
    return RunDetectorFitVerb(options.detector, folder, cli::IsInterrupted);
  if (*options.ladder.verb) return RunLadderVerb(options.ladder, folder, cli::IsInterrupted);
  if (*options.recognition.verb) {
    return RunRecognitionVerb(options.recognition, folder, cli::IsInterrupted);
  }
  if (*options.torso_poses.verb) {
    return RunTorsoPosesVerb(options.torso_poses, folder, cli::IsInterrupted);
  }
  if (*options.hypothesis.verb) {
    return RunHypothesisVerb(options.hypothesis, folder, backends.play_hypothesis,
                             cli::IsInterrupted);
  }
  return RunExperimentVerb(options, cli::IsInterrupted);
}

std::vector<cli::ProgramVerb> VerbsOf(CLI::App* app, const std::vector<std::string>& arguments,
                                      const LabBackends& backends) {
  const std::string& folder = backends.package_folder;
  cli::VerbTable table(app, {cli::CommandOf(kProgramName, arguments), folder});
  const auto report_of_experiment = [&table](ExperimentOptions* options) {
    table.SetCall(&options->hypothesis.report);
    return &options->report;
  };
  table.Add<ExperimentOptions>(
      AddExperimentVerb, report_of_experiment,
      [&](const ExperimentOptions& options) { return RunAnyExperiment(options, backends); });
  table.Add<ScenariosOptions>(
      AddScenariosVerb, cli::ReportOf<ScenariosOptions>, [&](const ScenariosOptions& options) {
        return RunScenariosVerb(options, folder, static_cast<bool>(backends.scenario_run),
                                cli::IsInterrupted);
      });
  table.Add<ExperiencesOptions>(
      AddExperiencesVerb, nullptr,
      [](const ExperiencesOptions& options) { return RunExperiencesVerb(options); },
      cli::OnSignal::kEnd);
  table.Add<ReproduceOptions>(AddReproduceVerb, cli::ReportOf<ReproduceOptions>,
                              [&](const ReproduceOptions& options) {
                                return RunReproduceVerb(options, folder, cli::IsInterrupted);
                              });
  table.Add<PublishOptions>(AddPublishVerb, nullptr, [&](const PublishOptions& options) {
    return RunPublishVerb(options, folder, cli::IsInterrupted);
  });
  table.Add<LabListOptions>(
      AddLabListVerb, nullptr,
      [&](const LabListOptions& options) { return RunLabListVerb(options, folder); },
      cli::OnSignal::kEnd);
  if (backends.hypothesis_run) {
    table.AddForeign(kHypothesisRunVerb, "one run of `experiment hypothesis`, which starts it",
                     backends.hypothesis_run, false);
  }
  if (backends.scenario_run) {
    table.AddForeign(kScenarioRunVerb, "one run of `scenarios --graph`, which starts it",
                     backends.scenario_run, false);
  }
  return table.Take();
}

}  // namespace

int RunLabCommandLine(const std::vector<std::string>& arguments, const LabBackends& backends) {
  const auto add_verbs = [&](CLI::App* app) { return VerbsOf(app, arguments, backends); };
  return cli::RunProgram(
      {kProgramName, "What judges HIRES: experiments, series, fits, and the dissertation's results",
       add_verbs},
      arguments);
}

}  // namespace hires::lab
