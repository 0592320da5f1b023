#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "hires/base/text.h"
#include "hires/imagination/evidence.h"
#include "lab/src/durations/durations_found.h"

namespace hires::lab {
namespace {

std::vector<std::string> LineOfMeans(const FoundDurations& found, std::size_t r) {
  const DurationsConfig::Row& row = found.durations().rows[r];
  std::vector<std::string> means;
  std::size_t reached = 0, runs = 0;
  for (std::size_t p = 0; p < found.durations().planners.size(); ++p) {
    if (p > 0 && !row.IsDrive()) {
      means.push_back("the same");
      continue;
    }
    const TimedRuns& timed = found.At(p, r);
    reached += timed.durations.size();
    runs += timed.runs;
    means.push_back(WithSigma(timed.mean(), Deviation(timed.durations)));
  }
  std::vector<std::string> line{DurationName(row), DurationRoute(row),
                                fmt::format("{} of {}", reached, runs)};
  line.insert(line.end(), means.begin(), means.end());
  line.push_back(WithSigma(row.simulated.mean, row.simulated.sigma));
  line.push_back(WithSigma(row.real.mean, row.real.sigma));
  return line;
}

TextTable TableOfMeans(const FoundDurations& found) {
  TextTable table{"Durations [s], mean ± sigma (1/N); played is what the names say from/to",
                  {{"action", "route", "reached"}}};
  std::vector<std::string>& heads = table.rows.front();
  for (const auto planner : found.durations().planners) {
    heads.push_back(fmt::format("found, {}", ToString(planner)));
  }
  heads.insert(heads.end(), {"simulated, 6.1", "real, 6.2"});
  for (std::size_t r = 0; r < found.durations().rows.size(); ++r) {
    table.rows.push_back(LineOfMeans(found, r));
  }
  return table;
}

/// "fast_EC1_ET2", for names of measures.
std::string KeyOf(const DurationsConfig::Row& row) {
  return fmt::format("{}_{}_{}", DurationName(row), row.from, row.to);
}

/// What each row found with the first planner.
void AddMeans(const FoundDurations& found, Findings* findings) {
  const std::vector<DurationsConfig::Row>& rows = found.durations().rows;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const TimedRuns& timed = found.At(0, r);
    const double sigma = timed.durations.empty() ? std::numeric_limits<double>::quiet_NaN()
                                                 : Deviation(timed.durations);
    findings->measures.push_back({"mean_" + KeyOf(rows[r]), timed.mean()});
    findings->measures.push_back({"sigma_" + KeyOf(rows[r]), sigma});
  }
}

/// Absolute errors of an action's means as they were played.
struct PlayedErrors {
  double mean{0.0}, largest{0.0};
};

PlayedErrors ErrorsOf(const FoundDurations& found, const DurationAction& action,
                      std::size_t planner, const DurationReading& reading,
                      DurationReference DurationsConfig::Row::*reference) {
  std::vector<double> errors;
  PlayedErrors out;
  for (const std::size_t r : found.RowsOf(action)) {
    const double expected = (found.durations().rows[r].*reference).mean;
    errors.push_back(std::abs(found.MeanOf(planner, r, reading) - expected));
    out.largest = WorseOf(errors.back(), out.largest);
  }
  out.mean = errors.empty() ? std::numeric_limits<double>::quiet_NaN() : base::Mean(errors);
  return out;
}

struct DurationTable {
  const char* title;
  const char* measure;
  DurationReference DurationsConfig::Row::*member;
};
const std::array<DurationTable, 2> kDurationTables{
    {{"simulated, 6.1", "_simulated", &DurationsConfig::Row::simulated},
     {"real, 6.2", "_real", &DurationsConfig::Row::real}}};

/// A line of errors as played for each reference: both readings and the worse of their means.
void AddErrors(const FoundDurations& found, const DurationAction& action, std::size_t planner,
               TextTable* table, Findings* findings) {
  const std::string who = ToString(found.durations().planners[planner]);
  for (const DurationTable& against : kDurationTables) {
    std::vector<std::string> line{action.title, *action.measure == '\0' ? who : "", against.title};
    double worse = 0.0;
    for (const DurationReading& reading : kDurationReadings) {
      const PlayedErrors errors = ErrorsOf(found, action, planner, reading, against.member);
      line.push_back(fmt::format("{:.2f}", errors.mean));
      line.push_back(fmt::format("{:.2f}", errors.largest));
      worse = WorseOf(errors.mean, worse);
      findings->measures.push_back(
          {fmt::format("mean_error{}{}{}{}", action.measure, against.measure,
                       planner == 0 ? "" : "_" + who, reading.measure),
           errors.mean});
    }
    line.push_back(fmt::format("{:.2f}", worse));
    table->rows.push_back(std::move(line));
  }
}

void AddPlayedErrors(const FoundDurations& found, Findings* findings) {
  TextTable table{
      "Absolute errors of the means as played [s]; what counts is the worse reading",
      {{"of", "planner", "against", "from/to", "largest", "to/from", "largest", "worse"}}};
  for (std::size_t p = 0; p < found.durations().planners.size(); ++p) {
    AddErrors(found, kDurationDrives, p, &table, findings);
  }
  for (const DurationAction& action : kDurationPostures) {
    if (!found.RowsOf(action).empty()) AddErrors(found, action, 0, &table, findings);
  }
  findings->tables.push_back(std::move(table));
}

/// Routes on which the second motion set of the file takes longer than the first.
int NumSlowerRoutes(const FoundDurations& found) {
  const std::vector<DurationsConfig::Row>& rows = found.durations().rows;
  int slower = 0;
  for (std::size_t a = 0; a < rows.size(); ++a) {
    for (std::size_t b = a + 1; b < rows.size(); ++b) {
      if (!rows[a].IsDrive() || !rows[b].IsDrive() ||
          DurationRoute(rows[a]) != DurationRoute(rows[b]))
        continue;
      slower += found.At(0, b).mean() > found.At(0, a).mean();
    }
  }
  return slower;
}

nlohmann::ordered_json RunOf(const DurationsConfig::Row& row, DurationsConfig::Planner planner,
                             std::size_t run, const imagination::RolloutResult& result) {
  return {{"action", row.action},
          {"motion_set", row.motion_set},
          {"planner", ToString(planner)},
          {"from", row.from},
          {"to", row.to},
          {"run", run},
          {"failure", base::ToString(result.failure.code)},
          {"subjects", base::Join(result.failure.subjects, " ")},
          {"action_finished", result.action_finished},
          {"duration", result.duration}};
}

void AddRuns(const DurationsConfig& durations, const DurationPlays& plays, Findings* findings) {
  int failed = 0;
  for (std::size_t p = 0; p < plays.size(); ++p) {
    for (std::size_t r = 0; r < plays[p].size(); ++r) {
      for (std::size_t i = 0; i < plays[p][r].size(); ++i) {
        const imagination::RolloutResult& result = plays[p][r][i];
        findings->rows.push_back(RunOf(durations.rows[r], durations.planners[p], i, result));
        findings->simulated_seconds += result.simulated;
        failed += imagination::ActionFailed(result) ? 1 : 0;
      }
    }
  }
  findings->measures.push_back({"failed", static_cast<double>(failed)});
}

}  // namespace

Findings SumUpDurations(const DurationsConfig& durations, const DurationPlays& plays) {
  const FoundDurations found(durations, plays);
  Findings findings;
  AddRuns(durations, plays, &findings);
  findings.measures.push_back({"slower_routes", static_cast<double>(NumSlowerRoutes(found))});
  findings.tables.push_back(TableOfMeans(found));
  AddMeans(found, &findings);
  AddPlayedErrors(found, &findings);
  AddDurationPredictions(found, &findings);
  return findings;
}

}  // namespace hires::lab
