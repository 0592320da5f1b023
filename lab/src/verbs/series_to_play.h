#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lab/src/verbs/scenarios_command.h"
#include "lab/src/series/overlaps.h"
#include "lab/src/series/scenario_series.h"
#include "lab/src/series/series_run.h"
#include "loop/task_loop.h"

namespace hires::lab {

/// A series with what its file leaves open filled in.
class SeriesToPlay {
 public:
  /// @pre options and package_folder outlive this.  @throws base::ConfigError for bad input.
  SeriesToPlay(const ScenariosOptions& options, const std::string& package_folder);

  const ScenarioSeries& series() const { return series_; }
  /// What its results depend on.
  const nlohmann::ordered_json& setting() const { return setting_; }
  const std::string& name() const { return name_; }  ///< of its journal

  /// All that is known of a run before it is played.
  SeriesRun Expected(int number) const;
  /// Writes what the run is played with into the folder.
  ScenarioOrder Prepare(const SeriesRun& run, const std::string& folder) const;

  /// Each combination of choices that is played can be made, the robot can be told so, and no
  /// answer is written over an input.
  /// @throws base::ConfigError naming the place that says what cannot be.
  void Check();

  /// What begins in each other in that run, though not where nothing is changed.  @pre Check()
  const std::vector<Overlap>& OverlapsOf(const SeriesRun& run) const {
    return overlaps_.at(run.choices);
  }

 private:
  /// A file that runs may begin from.
  struct Input {
    std::string what, path;
    std::string place;  ///< that names it, for messages: "--world"; empty: no one asks
  };

  SeriesStart StartOf(const std::vector<int>& choices) const;
  /// Where the value of a start stands that an option or a `!Scenario` gave; empty: neither did.
  std::string PlaceOf(const SeriesStart& start, const std::string& key,
                      const std::string& option, const std::string& typed) const;
  std::vector<std::vector<int>> ChoicesOfStarts() const;
  std::vector<Input> Inputs() const;
  std::string InputsHash() const;
  nlohmann::ordered_json MakeSetting() const;
  void CheckOutputs() const;
  /// That the robot can be told so.
  void CheckInstruction(const loop::LoopSetup& setup, const SeriesStart& start) const;

  const ScenariosOptions& options_;
  const std::string& package_folder_;
  const ScenarioSeries series_;
  const SeriesOrder order_;
  const nlohmann::ordered_json setting_;
  std::string name_;
  std::map<std::vector<int>, std::vector<Overlap>> overlaps_;  // by choices
};

}  // namespace hires::lab
