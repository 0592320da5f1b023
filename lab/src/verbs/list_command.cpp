#include "lab/src/verbs/list_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>

#include "hires/base/error.h"
#include "hires/base/spelling.h"
#include "hires/base/text.h"
#include "cli/exit_code.h"
#include "cli/outputs.h"
#include "cli/list_rows.h"
#include "lab/src/experiment/experiment.h"
#include "lab/src/series/scenario_series.h"

namespace hires::lab {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> YamlFilesIn(const std::string& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

cli::ListRows Experiments(const std::string& package_folder) {
  cli::ListRows rows;
  ExperimentOverrides overrides;
  overrides.map = "given";  // some want one; it is opened when they are played
  for (const fs::path& file : YamlFilesIn(package_folder + "/lab/config/experiments")) {
    rows.push_back({{"experiment", file.stem().string()},
                    {"kind", KindName(ReadExperiment(file, overrides))},
                    {"file", file.string()}});
  }
  return rows;
}

cli::ListRows SeriesOfRuns(const std::string& package_folder) {
  cli::ListRows rows;
  for (const fs::path& file : YamlFilesIn(package_folder + "/lab/config/series")) {
    const ScenarioSeries series = ReadScenarioSeries(file);
    std::vector<std::string> groups;
    for (const SeriesGroup& group : series.groups) groups.push_back(group.name);
    rows.push_back({{"series", series.name},
                    {"varies", groups},
                    {"combinations", NumCombinations(series)},
                    {"file", file.string()}});
  }
  return rows;
}

using Lister = std::function<cli::ListRows(const std::string& package_folder)>;

const std::map<std::string, Lister>& Listers() {
  static const std::map<std::string, Lister> listers{{"experiments", Experiments},
                                                     {"series", SeriesOfRuns}};
  return listers;
}

std::vector<std::string> Kinds() {
  std::vector<std::string> kinds;
  for (const auto& [kind, lister] : Listers()) kinds.push_back(kind);
  return kinds;
}

}  // namespace

void AddLabListVerb(CLI::App* app, LabListOptions* options) {
  const std::string kinds = base::Join(Kinds(), ", ");
  CLI::App* verb = app->add_subcommand("list", "names that other verbs take: " + kinds);
  verb->add_option("what", options->what, kinds)->required();
  verb->add_option("--json", options->json,
                   "write the list to this file as well; - : print it instead");
  options->verb = verb;
}

int RunLabListVerb(const LabListOptions& options, const std::string& package_folder) {
  const auto lister = Listers().find(options.what);
  if (lister == Listers().end()) {
    throw base::ConfigError(base::UnknownName("list", options.what, Kinds()));
  }
  cli::CheckOutputs({{"--json", options.json, true}}, {});
  cli::PrintList(options.what, lister->second(package_folder), options.json);
  return cli::kExitRecommended;
}

}  // namespace hires::lab
