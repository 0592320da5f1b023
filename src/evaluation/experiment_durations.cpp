#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "evaluation/experiment_kinds.h"
#include "hires/base/text.h"
#include "hires/evaluation/experiment_parallel.h"
#include "hires/evaluation/statistics.h"
#include "hires/imagination/evidence.h"

namespace hires::evaluation {
namespace {

/// What one row of the table found.
struct Timed {
  std::vector<double> durations;  // of runs that reached their goal
  int runs{0};

  double mean() const {
    return durations.empty() ? std::numeric_limits<double>::quiet_NaN() : Mean(durations);
  }
};

Timed TimedOf(const Rollouts& rollouts) {
  Timed timed;
  timed.runs = static_cast<int>(rollouts.size());
  for (const imagination::RolloutResult& result : rollouts) {
    if (!imagination::ActionFailed(result)) timed.durations.push_back(result.duration);
  }
  return timed;
}

std::string Reference(const DurationReference& reference) {
  return fmt::format("{:.2f} ± {:.2f}", reference.mean, reference.sigma);
}

std::vector<std::string> TableRow(const DurationsConfig::Row& row, const Timed& timed) {
  return {row.motion_set,
          row.from + "/" + row.to,
          fmt::format("{} of {}", timed.durations.size(), timed.runs),
          fmt::format("{:.2f} ± {:.2f}", timed.mean(), Deviation(timed.durations)),
          Reference(row.simulated),
          fmt::format("{:.2f}", timed.mean() - row.simulated.mean),
          Reference(row.real),
          fmt::format("{:.2f}", timed.mean() - row.real.mean)};
}

/// Errors of the means against one of the references.
struct Errors {
  const char* title;
  const char* measure;
  std::vector<double> absolute;
  double worst{0.0};

  double mean() const {
    return absolute.empty() ? std::numeric_limits<double>::quiet_NaN() : Mean(absolute);
  }

  void Add(double mean, double reference) {
    absolute.push_back(std::abs(mean - reference));
    // A row without any duration is no number, and stays one.
    worst = std::isnan(absolute.back()) || absolute.back() > worst ? absolute.back() : worst;
  }
};

/// The row of the way back with the same motion set, or nothing.
const DurationsConfig::Row* WayBack(const DurationsConfig& durations,
                                    const DurationsConfig::Row& row) {
  for (const DurationsConfig::Row& other : durations.rows) {
    if (other.motion_set == row.motion_set && other.from == row.to && other.to == row.from) {
      return &other;
    }
  }
  return nullptr;
}

/// Routes on which the second motion set of the file takes longer than the first.
int NumSlowerRoutes(const DurationsConfig& durations, const std::vector<Timed>& timed) {
  int slower = 0;
  for (std::size_t a = 0; a < durations.rows.size(); ++a) {
    for (std::size_t b = a + 1; b < durations.rows.size(); ++b) {
      const DurationsConfig::Row &first = durations.rows[a], &second = durations.rows[b];
      if (first.from != second.from || first.to != second.to) continue;
      slower += timed[b].mean() > timed[a].mean();
    }
  }
  return slower;
}

nlohmann::ordered_json RowOf(const DurationsConfig::Row& row, int run,
                             const imagination::RolloutResult& result) {
  return {{"motion_set", row.motion_set},
          {"from", row.from},
          {"to", row.to},
          {"run", run},
          {"failure", base::ToString(result.failure.code)},
          {"subjects", base::Join(result.failure.subjects, " ")},
          {"action_finished", result.action_finished},
          {"duration", result.duration}};
}

}  // namespace

std::optional<std::vector<Rollouts>> PlayDurations(const DurationsConfig& durations,
                                                   const ExperimentConfig& config,
                                                   const Stage& stage, const Crew& crew) {
  const int num_rows = static_cast<int>(durations.rows.size());
  std::vector<Rollouts> rollouts(num_rows, Rollouts(durations.runs));
  const auto play = [&](int task, const Advance& advance) {
    const int row = task % num_rows, run = task / num_rows;
    const DurationsConfig::Row& what = durations.rows[row];
    auto result =
        imagination::PlayRollout(SetupAt(stage, what.from, config.seed),
                                 DriveTo(what.to, what.motion_set), run, {crew.cancelled, {}});
    if (result) rollouts[row][run] = *std::move(result);
    advance(1.0);
  };
  const int num_tasks = num_rows * durations.runs;
  if (!DoInParallel(num_tasks, num_tasks, crew, play)) return std::nullopt;
  return rollouts;
}

Findings SumUpDurations(const DurationsConfig& durations, const std::vector<Rollouts>& rollouts) {
  Findings findings;
  TextTable table{"Durations [s], mean ± sigma (1/N), beside Tables 6.1 and 6.2",
                  {{"motion set", "route", "reached", "found", "simulated, 6.1", "difference",
                    "real, 6.2", "difference"}}};
  std::vector<Timed> timed;
  Errors simulated{"simulated, 6.1", "_simulated", {}}, real{"real, 6.2", "_real", {}},
      simulated_back{"simulated, of the way back", "_simulated_way_back", {}},
      real_back{"real, of the way back", "_real_way_back", {}};
  double failed = 0.0;
  std::vector<double> sigmas;
  for (std::size_t r = 0; r < durations.rows.size(); ++r) {
    const DurationsConfig::Row& row = durations.rows[r];
    timed.push_back(TimedOf(rollouts[r]));
    table.rows.push_back(TableRow(row, timed[r]));
    simulated.Add(timed[r].mean(), row.simulated.mean);
    real.Add(timed[r].mean(), row.real.mean);
    if (const DurationsConfig::Row* back = WayBack(durations, row)) {
      simulated_back.Add(timed[r].mean(), back->simulated.mean);
      real_back.Add(timed[r].mean(), back->real.mean);
    }
    sigmas.push_back(Deviation(timed[r].durations));
    failed += timed[r].runs - static_cast<double>(timed[r].durations.size());
    for (std::size_t i = 0; i < rollouts[r].size(); ++i) {
      findings.rows.push_back(RowOf(row, static_cast<int>(i), rollouts[r][i]));
      findings.simulated_seconds += rollouts[r][i].simulated;
    }
  }
  TextTable table_of_errors{"Absolute errors of the means [s]", {{"against", "mean", "largest"}}};
  findings.measures = {{"failed", failed},
                       {"mean_sigma", Mean(sigmas)},
                       {"slower_routes", static_cast<double>(NumSlowerRoutes(durations, timed))}};
  for (const Errors* errors : {&simulated, &real, &simulated_back, &real_back}) {
    table_of_errors.rows.push_back({errors->title, fmt::format("{:.2f}", errors->mean()),
                                    fmt::format("{:.2f}", errors->worst)});
    findings.measures.push_back({std::string("mean_error") + errors->measure, errors->mean()});
    findings.measures.push_back({std::string("max_error") + errors->measure, errors->worst});
  }
  findings.tables = {std::move(table), std::move(table_of_errors)};
  return findings;
}

}  // namespace hires::evaluation
