#include "hires/imagination/evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"

namespace hires::imagination {
namespace {

/// Values that know which rollout they came from; sorting keeps equals in index order.
using IndexedValues = std::vector<std::pair<double, int>>;

double Mean(const IndexedValues& values) {
  double sum = 0.0;
  for (const auto& [value, index] : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double Deviation(const IndexedValues& values, double mean) {
  double sum = 0.0;
  for (const auto& [value, index] : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

void SumUpDurations(IndexedValues durations, Evidence* evidence) {
  if (durations.empty()) return;
  std::sort(durations.begin(), durations.end());
  auto& duration = evidence->duration;
  for (const auto& [value, index] : durations) evidence->durations.push_back(value);
  duration.mean = Mean(durations);
  duration.sd = Deviation(durations, duration.mean);
  duration.p50 = Quantile(evidence->durations, 50);
  duration.p95 = Quantile(evidence->durations, 95);
  const auto first_median =
      std::lower_bound(durations.begin(), durations.end(), std::make_pair(duration.p50, -1));
  evidence->median_rollout = first_median->second;
}

void SumUpTilts(std::vector<double> tilts, Evidence* evidence) {
  if (tilts.empty()) return;
  std::sort(tilts.begin(), tilts.end());
  evidence->max_tilt = {Quantile(tilts, 50), Quantile(tilts, 95)};
  evidence->max_tilts = std::move(tilts);
}

/// Why these are no list of `what`, one for each of at most `most` rollouts; empty if they are.
std::string DefectOf(const std::vector<double>& values, const std::string& what, int most) {
  const bool is_finite =
      std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
  if (!is_finite) return fmt::format("a {} is not finite", what);
  if (!std::is_sorted(values.begin(), values.end())) {
    return fmt::format("{}s are not in ascending order", what);
  }
  if (values.size() <= static_cast<std::size_t>(most)) return {};
  return fmt::format("there are {} {}s of {} rollouts", values.size(), what, most);
}

/// Sums while walking over the rollouts; Finish() turns sums into shares.
class Tally {
 public:
  void Add(const RolloutResult& result, int index) {
    AddFailure(result, index);
    if (!result.first_cause.empty()) ++evidence_.first_causes[result.first_cause];
    NoteWorst(result, index);
    evidence_.counts += result.counts;
    evidence_.falls += result.falls;
    watched_nothing_ = watched_nothing_ && result.nothing_watched;
    num_fallen_ += result.falls > 0;
    confidence_sum_ += RolloutConfidence(result);
    if (!ActionFailed(result)) durations_.emplace_back(result.duration, index);
    if (result.counts.total() > 0) tilts_.push_back(result.max_tilt);
    ++evidence_.num_rollouts;
  }

  Evidence Finish(IntervalKind kind) {
    evidence_.success = EstimateSuccess(num_success_, evidence_.num_rollouts, kind);
    if (evidence_.num_rollouts == 0) return evidence_;
    const double n = evidence_.num_rollouts;
    const int num_action_failed = evidence_.num_rollouts - static_cast<int>(durations_.size());
    evidence_.fall_share = num_fallen_ / n;
    evidence_.action_failed_share = num_action_failed / n;
    evidence_.confidence_mean = confidence_sum_ / n;
    const bool mostly_failed = 2 * num_action_failed > evidence_.num_rollouts;
    evidence_.confidence_pooled = mostly_failed      ? 0.0
                                  : watched_nothing_ ? 1.0
                                                     : Confidence(evidence_.counts);
    SumUpDurations(std::move(durations_), &evidence_);
    SumUpTilts(std::move(tilts_), &evidence_);
    return evidence_;
  }

 private:
  void AddFailure(const RolloutResult& result, int index) {
    const base::Failure failure = FailureOf(result);
    if (!failure) {
      ++num_success_;
      return;
    }
    ++evidence_.failures[failure];
    if (evidence_.first_failed < 0) evidence_.first_failed = index;
  }

  void NoteWorst(const RolloutResult& result, int index) {
    const std::pair<bool, double> badness{static_cast<bool>(FailureOf(result)), result.max_tilt};
    if (evidence_.worst_rollout >= 0 && badness <= worst_) return;
    worst_ = badness;
    evidence_.worst_rollout = index;
  }

  Evidence evidence_;
  std::pair<bool, double> worst_{};  // has failed, largest tilt
  int num_success_{0};
  int num_fallen_{0};
  bool watched_nothing_{true};  // in every rollout
  double confidence_sum_{0.0};
  IndexedValues durations_;
  std::vector<double> tilts_;
};

}  // namespace

double Confidence(const OutcomeCounts& counts, const ConfidenceCoefficients& coefficients) {
  if (counts.total() == 0) return 0.0;
  return counts.total() /
         (coefficients.topple * counts.topple + coefficients.shaking * counts.shaking +
          coefficients.notopple * counts.notopple);
}

double RolloutConfidence(const RolloutResult& result) {
  if (ActionFailed(result)) return 0.0;
  return result.nothing_watched ? 1.0 : Confidence(result.counts);
}

double Quantile(const std::vector<double>& ascending, int percent) {
  HIRES_CHECK(!ascending.empty() && percent >= 0 && percent <= 100, "no such quantile");
  // Whole numbers keep 95 of 100 from becoming 96 by rounding.
  const std::size_t place = (ascending.size() * static_cast<std::size_t>(percent) + 99) / 100;
  return ascending[std::max<std::size_t>(place, 1) - 1];
}

std::string DefectOf(const Evidence& evidence) {
  const std::string defect = DefectOf(evidence.durations, "duration", evidence.num_rollouts);
  return defect.empty() ? DefectOf(evidence.max_tilts, "tilt", evidence.num_rollouts) : defect;
}

Evidence SumUp(const std::vector<RolloutResult>& results) {
  return SumUp(results, static_cast<int>(results.size()));
}

Evidence SumUp(const std::vector<RolloutResult>& results, int num_rollouts, IntervalKind kind,
               const Prices& prices) {
  return SumUpRequest({{&results, num_rollouts}}, kind, prices).front();
}

std::vector<Evidence> SumUpRequest(const std::vector<RolloutPrefix>& request, IntervalKind kind,
                                   const Prices& prices) {
  for (const RolloutPrefix& of_one : request) {
    HIRES_CHECK(
        of_one.num_rollouts >= 0 && of_one.num_rollouts <= static_cast<int>(of_one.results->size()),
        "there are not that many rollouts to sum up");
  }
  const double pseudo_penalty = prices.empty() ? 0.0 : PseudoPenalty(request, prices);
  std::vector<Evidence> evidence;
  for (const RolloutPrefix& of_one : request) {
    Tally tally;
    for (int i = 0; i < of_one.num_rollouts; ++i) {
      tally.Add((*of_one.results)[static_cast<std::size_t>(i)], i);
    }
    evidence.push_back(tally.Finish(kind));
    evidence.back().cost = EstimateCost(of_one, prices, pseudo_penalty, kind);
  }
  return evidence;
}

}  // namespace hires::imagination
