#pragma once

#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "lab/src/statistics.h"

// How well a number tells two kinds of moments apart, where moments of one run are not independent.
namespace hires::lab {

constexpr int kAreaResamples = 2000;  ///< of runs, for an interval of an area

/// Numbers of one run.
struct RunScores {
  std::vector<double> positive, negative;
};

/// Runs by kind. Resampling draws each kind's runs from its own, so that it keeps how many there
/// are.
using Strata = std::vector<std::vector<RunScores>>;

/// Runs of one kind are a stratum; those that are alone of their kind are one together.
/// @pre one kind for each of the runs.
Strata StrataOf(const std::vector<RunScores>& runs, const std::vector<std::string>& kinds);

/// Area under the ROC curve of all runs together: how often a positive has the larger number than a
/// negative (ties count half) [Mann, Whitney 1947]; not a number where one kind is missing.
double AreaUnderCurve(const std::vector<RunScores>& runs);

/// The area under the curve of all runs together, with the 2.5 % and 97.5 % percentiles over
/// kAreaResamples resamples of whole runs.
Interval AreaInterval(const Strata& strata, base::Rng rng);

/// Likewise of how often a positive has the larger number than a negative of its own stratum: areas
/// of the strata, weighted by their positives; strata that lack positives or negatives are left
/// out.
Interval AreaIntervalWithin(const Strata& strata, base::Rng rng);

struct RocPoint {
  double threshold{0.0}, false_alarms{0.0}, hits{0.0};  ///< shares
};
/// At most `most` points of the curve, from none to all.
std::vector<RocPoint> RocOf(const std::vector<RunScores>& runs, std::size_t most);

/// The threshold with the largest hits - false alarms.
RocPoint BestThreshold(const std::vector<RunScores>& runs);
/// What a threshold does to these runs.
RocPoint JudgedAt(const std::vector<RunScores>& runs, double threshold);

}  // namespace hires::lab
