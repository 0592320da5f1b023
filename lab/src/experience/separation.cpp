#include "lab/src/experience/separation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "hires/base/check.h"

namespace hires::lab {
namespace {

struct Scored {
  double score;
  bool is_positive;
};

std::vector<Scored> Sorted(const std::vector<RunScores>& runs) {
  std::vector<Scored> all;
  for (const RunScores& run : runs) {
    for (const double score : run.positive) all.push_back({score, true});
    for (const double score : run.negative) all.push_back({score, false});
  }
  std::sort(all.begin(), all.end(),
            [](const Scored& a, const Scored& b) { return a.score < b.score; });
  return all;
}

/// Calls `take` for each group of equal scores, the largest first.
template <typename Take>
void FromTheTop(const std::vector<Scored>& sorted, const Take& take) {
  for (std::size_t end = sorted.size(); end > 0;) {
    std::size_t begin = end;
    double positive = 0.0, negative = 0.0;
    while (begin > 0 && sorted[begin - 1].score == sorted[end - 1].score) {
      --begin;
      (sorted[begin].is_positive ? positive : negative) += 1.0;
    }
    take(sorted[end - 1].score, positive, negative);
    end = begin;
  }
}

struct Totals {
  double positive{0.0}, negative{0.0};
};

Totals TotalsOf(const std::vector<Scored>& all) {
  Totals totals;
  for (const Scored& one : all) (one.is_positive ? totals.positive : totals.negative) += 1.0;
  return totals;
}

/// A run's scores counted in bins that hold equally many of all: resampling counts is quick, and
/// what falls into one bin is tied, which moves an area by less than a bin's share.
constexpr std::size_t kAreaBins = 1024;
struct BinnedRun {
  std::array<double, kAreaBins> positive{}, negative{};
};

std::vector<double> EdgesOfBins(const std::vector<RunScores>& runs) {
  const std::vector<Scored> sorted = Sorted(runs);
  std::vector<double> edges;
  for (std::size_t b = 1; b < kAreaBins && !sorted.empty(); ++b) {
    edges.push_back(sorted[b * sorted.size() / kAreaBins].score);
  }
  return edges;
}

std::vector<BinnedRun> BinnedRunsOf(const std::vector<RunScores>& runs,
                                    const std::vector<double>& edges) {
  const auto bin = [&](double score) {
    return std::upper_bound(edges.begin(), edges.end(), score) - edges.begin();
  };
  std::vector<BinnedRun> binned(runs.size());
  for (std::size_t r = 0; r < runs.size(); ++r) {
    for (const double score : runs[r].positive) binned[r].positive[bin(score)] += 1.0;
    for (const double score : runs[r].negative) binned[r].negative[bin(score)] += 1.0;
  }
  return binned;
}

void Add(const BinnedRun& run, BinnedRun* sum) {
  for (std::size_t b = 0; b < kAreaBins; ++b) {
    sum->positive[b] += run.positive[b];
    sum->negative[b] += run.negative[b];
  }
}

/// As many of the runs as there are, added up.
BinnedRun Resampled(const std::vector<BinnedRun>& runs, base::Rng* rng) {
  BinnedRun resample;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    Add(runs[rng->Index(static_cast<int>(runs.size()))], &resample);
  }
  return resample;
}

double PositivesOf(const std::vector<RunScores>& runs) {
  double positives = 0.0;
  for (const RunScores& run : runs) positives += static_cast<double>(run.positive.size());
  return positives;
}

/// A mean of areas by their positives.
class WeightedArea {
 public:
  void Add(double area, double positives) {
    if (!std::isfinite(area)) return;
    sum_ += positives * area;
    positives_ += positives;
  }
  double mean() const {
    return positives_ > 0.0 ? sum_ / positives_ : std::numeric_limits<double>::quiet_NaN();
  }

 private:
  double sum_{0.0}, positives_{0.0};
};

double AreaOf(const BinnedRun& run) {
  double hits = 0.0, alarms = 0.0, area = 0.0;
  for (std::size_t b = kAreaBins; b-- > 0;) {
    area += run.negative[b] * (hits + 0.5 * run.positive[b]);
    hits += run.positive[b];
    alarms += run.negative[b];
  }
  return hits * alarms > 0.0 ? area / (hits * alarms) : std::numeric_limits<double>::quiet_NaN();
}

/// @param area_of  the area of one resample, which comes as a sum of runs for each stratum.
template <typename Area>
Interval ResampledInterval(double estimate, const std::vector<std::vector<BinnedRun>>& strata,
                           base::Rng rng, const Area& area_of) {
  std::vector<double> areas;
  std::vector<BinnedRun> resample(strata.size());
  for (int i = 0; i < kAreaResamples; ++i) {
    for (std::size_t s = 0; s < strata.size(); ++s) resample[s] = Resampled(strata[s], &rng);
    const double area = area_of(resample);
    if (std::isfinite(area)) areas.push_back(area);
  }
  if (areas.empty()) return {estimate, estimate, estimate};
  std::sort(areas.begin(), areas.end());
  const auto at = [&](double share) {
    return areas[static_cast<std::size_t>(share * static_cast<double>(areas.size() - 1))];
  };
  return {estimate, at(0.025), at(0.975)};
}

}  // namespace

Strata StrataOf(const std::vector<RunScores>& runs, const std::vector<std::string>& kinds) {
  HIRES_CHECK(runs.size() == kinds.size(), "each run has a kind");
  std::map<std::string, std::vector<RunScores>> by_kind;
  for (std::size_t r = 0; r < runs.size(); ++r) by_kind[kinds[r]].push_back(runs[r]);
  Strata strata;
  std::vector<RunScores> alone;
  for (auto& [kind, of_kind] : by_kind) {
    if (of_kind.size() > 1) {
      strata.push_back(std::move(of_kind));
    } else {
      alone.push_back(std::move(of_kind.front()));
    }
  }
  if (!alone.empty()) strata.push_back(std::move(alone));
  return strata;
}

double AreaUnderCurve(const std::vector<RunScores>& runs) {
  const std::vector<Scored> sorted = Sorted(runs);
  const Totals totals = TotalsOf(sorted);
  double hits = 0.0, area = 0.0;
  FromTheTop(sorted, [&](double, double positive, double negative) {
    area += negative * (hits + 0.5 * positive);
    hits += positive;
  });
  const double all = totals.positive * totals.negative;
  return all > 0.0 ? area / all : std::numeric_limits<double>::quiet_NaN();
}

Interval AreaInterval(const Strata& strata, base::Rng rng) {
  std::vector<RunScores> all;
  for (const std::vector<RunScores>& runs : strata) all.insert(all.end(), runs.begin(), runs.end());
  const std::vector<double> edges = EdgesOfBins(all);
  std::vector<std::vector<BinnedRun>> binned;
  for (const std::vector<RunScores>& runs : strata) binned.push_back(BinnedRunsOf(runs, edges));
  return ResampledInterval(AreaUnderCurve(all), binned, rng,
                           [](const std::vector<BinnedRun>& resample) {
                             BinnedRun sum;
                             for (const BinnedRun& stratum : resample) Add(stratum, &sum);
                             return AreaOf(sum);
                           });
}

Interval AreaIntervalWithin(const Strata& strata, base::Rng rng) {
  WeightedArea whole;
  std::vector<std::vector<BinnedRun>> binned;
  for (const std::vector<RunScores>& runs : strata) {
    whole.Add(AreaUnderCurve(runs), PositivesOf(runs));
    binned.push_back(BinnedRunsOf(runs, EdgesOfBins(runs)));
  }
  return ResampledInterval(whole.mean(), binned, rng, [](const std::vector<BinnedRun>& resample) {
    WeightedArea mean;
    for (const BinnedRun& stratum : resample) {
      mean.Add(AreaOf(stratum),
               std::accumulate(stratum.positive.begin(), stratum.positive.end(), 0.0));
    }
    return mean.mean();
  });
}

std::vector<RocPoint> RocOf(const std::vector<RunScores>& runs, std::size_t most) {
  const std::vector<Scored> sorted = Sorted(runs);
  const Totals totals = TotalsOf(sorted);
  std::vector<RocPoint> points;
  double hits = 0.0, alarms = 0.0;
  FromTheTop(sorted, [&](double score, double positive, double negative) {
    hits += positive;
    alarms += negative;
    points.push_back({score, alarms / totals.negative, hits / totals.positive});
  });
  if (points.size() <= most) return points;
  std::vector<RocPoint> kept;
  for (std::size_t i = 0; i < most; ++i)
    kept.push_back(points[i * (points.size() - 1) / (most - 1)]);
  return kept;
}

RocPoint BestThreshold(const std::vector<RunScores>& runs) {
  RocPoint best{std::numeric_limits<double>::infinity(), 0.0, 0.0};
  for (const RocPoint& point : RocOf(runs, std::numeric_limits<std::size_t>::max())) {
    if (point.hits - point.false_alarms > best.hits - best.false_alarms) best = point;
  }
  return best;
}

RocPoint JudgedAt(const std::vector<RunScores>& runs, double threshold) {
  const std::vector<Scored> all = Sorted(runs);
  const Totals totals = TotalsOf(all);
  double hits = 0.0, alarms = 0.0;
  for (const Scored& one : all) {
    if (one.score >= threshold) (one.is_positive ? hits : alarms) += 1.0;
  }
  return {threshold, alarms / totals.negative, hits / totals.positive};
}

}  // namespace hires::lab
