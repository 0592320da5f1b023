#pragma once

#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/evaluation/statistics.h"

// How well a number tells two kinds of moments apart, where moments of one run are not independent.
namespace hires::evaluation {

/// Numbers of one run.
struct RunScores {
  std::vector<double> positive, negative;
};

/// Area under the ROC curve of all runs together: how often a positive has the larger number than a
/// negative (ties count half) [Mann, Whitney 1947]; not a number where one kind is missing.
double AreaUnderCurve(const std::vector<RunScores>& runs);

/// With the 2.5 % and 97.5 % percentiles over resamples of whole runs.
Interval AreaInterval(const std::vector<RunScores>& runs, base::Rng rng);

/// How often a positive has the larger number than a negative of its own stratum: areas of the
/// strata, weighted by their positives; strata that lack one kind are left out. Runs are resampled
/// within their stratum.
Interval AreaIntervalWithin(const std::vector<std::vector<RunScores>>& strata, base::Rng rng);

struct RocPoint {
  double threshold{0.0}, false_alarms{0.0}, hits{0.0};  ///< shares
};
/// At most `most` points of the curve, from none to all.
std::vector<RocPoint> RocOf(const std::vector<RunScores>& runs, std::size_t most);

/// The threshold with the largest hits - false alarms.
RocPoint BestThreshold(const std::vector<RunScores>& runs);
/// What a threshold does to these runs.
RocPoint JudgedAt(const std::vector<RunScores>& runs, double threshold);

}  // namespace hires::evaluation
