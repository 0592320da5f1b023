#include "cli/save_rollout.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>

#include "hires/base/error.h"
#include "hires/evaluation/report_json.h"
#include "hires/evaluation/timeline.h"
#include "hires/imagination/imagination_setup.h"

namespace hires::cli {
namespace {

using imagination::RolloutRecording;

const imagination::Prediction& PredictionOf(const imagination::RolloutChoice& choice,
                                            const imagination::Report& report) {
  const auto rank = static_cast<std::size_t>(choice.rank);
  if (rank <= report.ranking.size()) return report.ranking[rank - 1];
  throw base::ConfigError(
      fmt::format("--save-rollout: rank {} of {} alternatives; choose a lower one", choice.rank,
                  report.ranking.size()));
}

imagination::RolloutSetup SetupOf(const ImagineQuery& query) {
  const imagination::ImaginationSetup setup = imagination::LoadImaginationSetup(query.setup);
  return imagination::MakeRolloutSetup(
      setup, imagination::MakeStartState(setup, query.start.AllAtoms(), query.start.put),
      query.seed);
}

void RequireAmong(const imagination::Evidence& evidence, const RolloutRecording& recording) {
  if (imagination::IsAmong(evidence, recording.result)) return;
  throw base::ConfigError(fmt::format(
      "--save-rollout: rollout {} played here is none of those that were imagined; the workers "
      "have "
      "another build or other files than this program: name them by --world, --robot, --objects",
      recording.index));
}

void Print(const RolloutRecording& recording, const SaveRolloutOptions& options) {
  std::cout << fmt::format("rollout {} of {}, seed {}:\n", recording.index,
                           ToString(recording.action), recording.seed);
  for (const imagination::RolloutEvent& event : recording.events) {
    std::cout << fmt::format("{:8.2f} s  {}\n", event.time, event.text);
  }
  for (const std::string& path : {options.csv, options.bag}) {
    if (!path.empty()) std::cout << "saved to " << path << '\n';
  }
}

}  // namespace

void AddSaveRolloutOptions(CLI::App* app, SaveRolloutOptions* o) {
  CLI::Option* which = app->add_option(
      "--save-rollout", o->which,
      "play one rollout again and save it: worst, median, first_fall, or its number; of the first "
      "alternative in the table, or of the third: worst@3");
  app->add_option("--csv", o->csv, "with --save-rollout: to this table, for plotting")
      ->needs(which);
  app->add_option(
         "--bag", o->bag,
         "with --save-rollout: to this bag, with the topics of a PR2 and markers, for RViz, "
         "PlotJuggler, Foxglove")
      ->needs(which);
}

void CheckSaveRollout(const SaveRolloutOptions& options, const OpenRolloutBag& open_bag) {
  if (options.which.empty()) return;
  imagination::ParseRolloutChoice(options.which);
  if (options.csv.empty() && options.bag.empty()) {
    throw base::ConfigError("--save-rollout: nowhere to save it to; add --csv FILE or --bag FILE");
  }
  if (!options.bag.empty() && !open_bag) {
    throw base::ConfigError("--bag: this build has no ROS to write bags with; use --csv FILE");
  }
  for (const std::string& path : {options.csv, options.bag}) {
    if (!path.empty()) evaluation::RequireFolderOf(path);
  }
}

void SaveRollout(const SaveRolloutOptions& options, const ImagineQuery& query,
                 const imagination::Report& report, const OpenRolloutBag& open_bag,
                 const std::function<bool()>& cancelled) {
  if (options.which.empty()) return;
  const imagination::RolloutChoice choice = imagination::ParseRolloutChoice(options.which);
  const imagination::Prediction& prediction = PredictionOf(choice, report);
  const int index = imagination::IndexOf(choice, prediction.evidence);
  const imagination::RolloutSetup setup = SetupOf(query);
  const std::unique_ptr<imagination::RolloutWatcher> bag =
      options.bag.empty() ? nullptr : open_bag(options.bag, setup);
  const auto recording =
      imagination::RecordRollout(setup, prediction.action, index, cancelled, bag.get());
  if (!recording) return;
  RequireAmong(prediction.evidence, *recording);
  if (!options.csv.empty()) evaluation::WriteText(imagination::ToCsv(*recording), options.csv);
  if (bag) bag->OnEnd(*recording);
  Print(*recording, options);
}

}  // namespace hires::cli
