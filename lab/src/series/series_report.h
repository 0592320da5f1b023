#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lab/src/series/scenario_series.h"
#include "lab/src/series/series_run.h"
#include "lab/src/statistics.h"

namespace hires::lab {

/// All that became of a series.
struct SeriesReport {
  ScenarioSeries series;
  std::vector<SeriesRun> runs;
  std::size_t stored{0};   ///< episodes that the folder holds now, those of other series included
  std::string repository;  ///< the folder's name
};

/// How runs ended in which a group took a choice. Broken ones are left out: they say nothing of it.
struct ChoiceShare {
  std::string group;
  int choice{0};                     ///< from 0
  std::vector<std::string> members;  ///< what differs by it, with what it is: "poseTable1 hasX 1"
  int succeeded{0}, played{0};
  Interval share;  ///< of successes, Wilson's
};
std::vector<ChoiceShare> SharesByChoice(const SeriesReport& report);

/// What runs took on average. Those of which no episode was kept are left out.
struct SeriesAverages {
  int runs{0};  ///< that the others rest on; of none they are 0
  double simulated_seconds{0.0};
  double fluents{0.0};             ///< of an episode, what was known before included
  double fluents_per_second{0.0};  ///< [1/s] fluents of all runs / seconds of all runs
  /// The same two without the fluents that were known before the run; nothing where a run does not
  /// tell how many these are.
  std::optional<double> new_fluents, new_fluents_per_second;
};
SeriesAverages AveragesOf(const std::vector<SeriesRun>& runs);

/// The summary of a run in the layout of the dissertation's Listing 5.2, and how it ended.
std::string RunSummary(const SeriesRun& run);

/// That of all runs; then averages over all and over those that succeeded, run by run how it ended,
/// how many ended how, and what differed.
std::string SeriesSummary(const SeriesReport& report);

/// A line for each run, with a head.
std::string SeriesCsv(const SeriesReport& report);

/// Everything for machines. Equal for equal runs, however often the series was interrupted. The
/// `averages` are those of all runs and of those that succeeded as the execution monitor says, null
/// where there are none. `mean_fluents`, `mean_fluents_per_second` (fluents of all runs / seconds
/// of all runs, no mean of the runs' own rates) and `mean_simulated_seconds` are those of all runs.
nlohmann::ordered_json ToJson(const SeriesReport& report);

}  // namespace hires::lab
