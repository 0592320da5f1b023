#include "lab/src/durations/durations_found.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "hires/imagination/evidence.h"

namespace hires::lab {
namespace {

TimedRuns TimedOf(const Rollouts& rollouts) {
  TimedRuns timed;
  timed.runs = rollouts.size();
  for (const imagination::RolloutResult& result : rollouts) {
    if (!imagination::ActionFailed(result)) timed.durations.push_back(result.duration);
  }
  return timed;
}

}  // namespace

double TimedRuns::mean() const {
  return durations.empty() ? std::numeric_limits<double>::quiet_NaN() : base::Mean(durations);
}

FoundDurations::FoundDurations(const DurationsConfig& durations, const DurationPlays& plays)
    : durations_(durations) {
  for (const std::vector<Rollouts>& by_row : plays) {
    timed_.emplace_back();
    for (const Rollouts& rollouts : by_row) timed_.back().push_back(TimedOf(rollouts));
  }
}

const TimedRuns& FoundDurations::At(std::size_t planner, std::size_t row) const {
  return timed_[durations_.rows[row].IsDrive() ? planner : 0][row];
}

double FoundDurations::MeanOf(std::size_t planner, std::size_t row,
                              const DurationReading& reading) const {
  return At(planner, reading.reversed ? WayBack(durations_, row) : row).mean();
}

std::vector<std::size_t> FoundDurations::RowsOf(const DurationAction& action) const {
  std::vector<std::size_t> rows;
  for (std::size_t r = 0; r < durations_.rows.size(); ++r) {
    if (durations_.rows[r].action == action.name) rows.push_back(r);
  }
  return rows;
}

DurationRows FoundDurations::DataOf(const DurationAction& action, std::size_t planner,
                                    const DurationReading& reading) const {
  DurationRows data;
  for (const std::size_t r : RowsOf(action)) {
    const DurationsConfig::Row& row = durations_.rows[r];
    data.push_back(
        {DurationRoute(row), MeanOf(planner, r, reading), row.real.mean, row.real.sigma});
  }
  return data;
}

std::string DurationRoute(const DurationsConfig::Row& row) { return row.from + '/' + row.to; }

std::string DurationName(const DurationsConfig::Row& row) {
  return row.IsDrive() ? row.motion_set : row.action;
}

std::string WithSigma(double mean, double sigma) {
  return fmt::format("{:.2f} ± {:.2f}", mean, sigma);
}

double WorseOf(double a, double b) { return std::isnan(a) || a > b ? a : b; }

}  // namespace hires::lab
