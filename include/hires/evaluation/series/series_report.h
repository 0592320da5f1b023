#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "hires/evaluation/series/scenario_series.h"
#include "hires/evaluation/series/series_run.h"
#include "hires/evaluation/statistics.h"

namespace hires::evaluation {

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

/// The summary of a run in the layout of the dissertation's Listing 5.2, and how it ended.
std::string RunSummary(const SeriesRun& run);

/// That of all runs; then how many ended how, run by run, and what differed.
std::string SeriesSummary(const SeriesReport& report);

/// A line for each run, with a head.
std::string SeriesCsv(const SeriesReport& report);

/// Everything for machines. Equal for equal runs, however often the series was interrupted.
nlohmann::ordered_json ToJson(const SeriesReport& report);

}  // namespace hires::evaluation
