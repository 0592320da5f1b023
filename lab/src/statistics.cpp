#include "lab/src/statistics.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "hires/base/check.h"

namespace hires::lab {
namespace {

constexpr double kTail = 0.025;

double SquaredDeviations(const std::vector<double>& values) {
  const double mean = Mean(values);
  double sum = 0.0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return sum;
}

void CheckCounts(const PairedCounts& counts) {
  HIRES_CHECK(counts.only_first >= 0 && counts.only_second >= 0 &&
                  counts.only_first + counts.only_second <= counts.num_pairs,
              "there are more discordant pairs than pairs, or fewer than none");
}

/// Counts need not be whole.  @pre 0 <= hits <= all, all > 0.
Interval ExactShare(double hits, double all) {
  using Binomial = boost::math::binomial;
  return {hits / all, hits <= 0.0 ? 0.0 : Binomial::find_lower_bound_on_p(all, hits, kTail),
          hits >= all ? 1.0 : Binomial::find_upper_bound_on_p(all, hits, kTail)};
}

double StudentsT(double freedom) {
  return boost::math::quantile(boost::math::students_t(freedom), 1.0 - kTail);
}

/// Sums over clusters.
struct ClusterSums {
  double clusters{0.0}, cases{0.0}, hits{0.0};
  double with_hit{0.0}, with_miss{0.0};  ///< clusters
  double squared_sizes{0.0};
  double share() const { return hits / cases; }
};

/// @return of clusters that are not empty.
ClusterSums ClusterSumsOf(const std::vector<ClusterCounts>& clusters) {
  ClusterSums sums;
  for (const auto& [num_hits, num_all] : clusters) {
    HIRES_CHECK(num_hits >= 0 && num_hits <= num_all,
                "a cluster has more hits than cases, or fewer than none");
    sums.clusters += num_all > 0 ? 1.0 : 0.0;
    sums.with_hit += num_hits > 0 ? 1.0 : 0.0;
    sums.with_miss += num_hits < num_all ? 1.0 : 0.0;
    sums.cases += num_all;
    sums.hits += num_hits;
    sums.squared_sizes += static_cast<double>(num_all) * num_all;
  }
  return sums;
}

/// By how much the share varies more than that of as many independent cases, in variance.
double DesignEffect(const std::vector<ClusterCounts>& clusters, const ClusterSums& sums) {
  const double k = sums.clusters, n = sums.cases, share = sums.share();
  double squares = 0.0;
  for (const ClusterCounts& one : clusters)
    squares += std::pow(one.num_hits - share * one.num_all, 2);
  return k / (k - 1.0) * squares / (n * n) / (share * (1.0 - share) / (n - 1.0));
}

/// How many independent cases say as much about the share.
double IndependentCases(const std::vector<ClusterCounts>& clusters, const ClusterSums& sums) {
  const double n = sums.cases, rarer = std::min(sums.with_hit, sums.with_miss);
  const double if_all_alike = sums.squared_sizes / n;
  if (rarer == 0.0 || sums.clusters < 2.0) return n / if_all_alike;
  const double effect = (rarer * DesignEffect(clusters, sums) + if_all_alike) / (rarer + 1.0);
  const double ratio = StudentsT(n - 1.0) / StudentsT(sums.clusters - 1.0);
  return std::clamp(n / effect * ratio * ratio, 1.0, n);
}

/// Tango's score statistic of a difference, its numerator positive where the difference is too
/// small. The standard error holds the second cell's share at its restricted maximum of likelihood.
double PairedScore(const PairedCounts& counts, double difference) {
  const double n = counts.num_pairs, first = counts.only_first, second = counts.only_second;
  const double a = 2.0 * n;
  const double b = (2.0 * n - first + second) * difference - first - second;
  const double c = -second * difference * (1.0 - difference);
  const double share = (std::sqrt(std::max(0.0, b * b - 4.0 * a * c)) - b) / (2.0 * a);
  const double variance = n * (2.0 * share + difference * (1.0 - difference));
  const double numerator = first - second - n * difference;
  if (variance > 0.0) return numerator / std::sqrt(variance);
  return numerator == 0.0 ? 0.0 : std::copysign(std::numeric_limits<double>::infinity(), numerator);
}

/// The largest difference in [lower, upper] whose score is at least `bound`, by halving: the score
/// falls with the difference.
double WhereScoreIs(const PairedCounts& counts, double bound, double lower, double upper) {
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (lower + upper);
    (PairedScore(counts, middle) >= bound ? lower : upper) = middle;
  }
  return 0.5 * (lower + upper);
}

/// Of all signs, the share whose sum is at least as far from 0 as `sum`.
double ShareOfAllFlips(const std::vector<double>& sizes, double bound) {
  const std::size_t all = std::size_t{1} << sizes.size();
  std::size_t as_far = 0;
  for (std::size_t signs = 0; signs < all; ++signs) {
    double flipped = 0.0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      flipped += (signs >> i & 1U) != 0 ? sizes[i] : -sizes[i];
    }
    as_far += std::abs(flipped) >= bound ? 1 : 0;
  }
  return static_cast<double>(as_far) / static_cast<double>(all);
}

double ShareOfDrawnFlips(const std::vector<double>& sizes, double bound, base::Rng* rng) {
  constexpr int kDraws = 20000;
  int as_far = 1;  // what was seen is one of them
  for (int draw = 0; draw < kDraws; ++draw) {
    double flipped = 0.0;
    for (const double size : sizes) flipped += rng->Bernoulli(0.5) ? size : -size;
    as_far += std::abs(flipped) >= bound ? 1 : 0;
  }
  return static_cast<double>(as_far) / (kDraws + 1);
}

}  // namespace

Interval BootstrapInterval(const std::vector<double>& values, base::Rng rng) {
  constexpr int kResamples = 10000;
  if (values.empty()) return {};
  const int num = static_cast<int>(values.size());
  std::vector<double> means(kResamples, 0.0);
  for (double& mean : means) {
    for (int i = 0; i < num; ++i) mean += values[rng.Index(num)];
    mean /= num;
  }
  return PercentileInterval(Mean(values), std::move(means));
}

Interval PercentileInterval(double estimate, std::vector<double> resampled) {
  const auto is_no_number = [](double value) { return std::isnan(value); };
  resampled.erase(std::remove_if(resampled.begin(), resampled.end(), is_no_number),
                  resampled.end());
  constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
  if (resampled.empty()) return {estimate, kNoNumber, kNoNumber};
  std::sort(resampled.begin(), resampled.end());
  const double last = static_cast<double>(resampled.size() - 1);
  const auto at = [&](double share) {
    return resampled[static_cast<std::size_t>(std::lround(share * last))];
  };
  return {estimate, at(kTail), at(1.0 - kTail)};
}

double Deviation(const std::vector<double>& values) {
  if (values.empty()) return 0.0;
  return std::sqrt(SquaredDeviations(values) / static_cast<double>(values.size()));
}

Interval MeanInterval(const std::vector<double>& differences) {
  const double n = static_cast<double>(differences.size());
  if (differences.empty()) return {};
  const double mean = Mean(differences);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (differences.size() == 1) return {mean, -kInfinity, kInfinity};
  const double error = std::sqrt(SquaredDeviations(differences) / (n - 1.0) / n);
  const double t = StudentsT(n - 1.0);
  return {mean, mean - t * error, mean + t * error};
}

Interval ShareInterval(int num_hits, int num_all) {
  HIRES_CHECK(num_hits >= 0 && num_hits <= num_all, "there are more hits than all, or fewer");
  if (num_all == 0) return {0.0, 0.0, 1.0};
  return ExactShare(num_hits, num_all);
}

ClusterCounts SumOf(const std::vector<ClusterCounts>& clusters) {
  ClusterCounts sum;
  for (const ClusterCounts& one : clusters) {
    sum.num_hits += one.num_hits;
    sum.num_all += one.num_all;
  }
  return sum;
}

Interval ClusteredShareInterval(const std::vector<ClusterCounts>& clusters) {
  const ClusterSums sums = ClusterSumsOf(clusters);
  if (sums.cases == 0.0) return {0.0, 0.0, 1.0};
  const double cases = IndependentCases(clusters, sums);
  Interval interval = ExactShare(std::min(1.0, sums.share()) * cases, cases);
  interval.estimate = sums.share();
  return interval;
}

Interval WilsonInterval(int num_hits, int num_all) {
  HIRES_CHECK(num_hits >= 0 && num_hits <= num_all, "there are more hits than all, or fewer");
  if (num_all == 0) return {0.0, 0.0, 1.0};
  const double z = boost::math::quantile(boost::math::normal(), 1.0 - kTail);
  const double n = num_all, share = num_hits / n, weight = 1.0 / (1.0 + z * z / n);
  const double middle = weight * (share + z * z / (2.0 * n));
  const double half = weight * z * std::sqrt(share * (1.0 - share) / n + z * z / (4.0 * n * n));
  return {share, num_hits == 0 ? 0.0 : middle - half, num_hits == num_all ? 1.0 : middle + half};
}

Interval PairedShareDifference(const PairedCounts& counts) {
  CheckCounts(counts);
  const int discordant = counts.only_first + counts.only_second;
  if (counts.num_pairs == 0) return {0.0, -1.0, 1.0};
  if (discordant == 0) {
    const double most = ShareInterval(0, counts.num_pairs).upper;
    return {0.0, -most, most};
  }
  const Interval first = ShareInterval(counts.only_first, discordant);
  const double share = static_cast<double>(discordant) / counts.num_pairs;
  const auto difference = [share](double p) { return (2.0 * p - 1.0) * share; };
  return {difference(first.estimate), difference(first.lower), difference(first.upper)};
}

Interval PairedScoreInterval(const PairedCounts& counts) {
  CheckCounts(counts);
  if (counts.num_pairs == 0) return {0.0, -1.0, 1.0};
  const double estimate =
      static_cast<double>(counts.only_first - counts.only_second) / counts.num_pairs;
  const double z = boost::math::quantile(boost::math::normal(), 1.0 - kTail);
  return {estimate, WhereScoreIs(counts, z, -1.0, estimate),
          WhereScoreIs(counts, -z, estimate, 1.0)};
}

double McNemarPValue(const PairedCounts& counts) {
  CheckCounts(counts);
  const int discordant = counts.only_first + counts.only_second;
  if (discordant == 0) return 1.0;
  const boost::math::binomial even(discordant, 0.5);
  const double tail = boost::math::cdf(even, std::min(counts.only_first, counts.only_second));
  return std::min(1.0, 2.0 * tail);
}

double SignFlipPValue(const std::vector<double>& differences, base::Rng rng) {
  constexpr std::size_t kMostForAll = 16;
  std::vector<double> sizes;
  double sum = 0.0, size = 0.0;
  for (const double difference : differences) {
    if (difference == 0.0) continue;
    sizes.push_back(difference);
    sum += difference;
    size += std::abs(difference);
  }
  if (sizes.empty()) return 1.0;
  const double bound = std::abs(sum) - 1e-12 * size;  // sums of the same numbers round differently
  return sizes.size() <= kMostForAll ? ShareOfAllFlips(sizes, bound)
                                     : ShareOfDrawnFlips(sizes, bound, &rng);
}

}  // namespace hires::lab
