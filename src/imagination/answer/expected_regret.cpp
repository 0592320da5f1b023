#include "hires/imagination/expected_regret.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "hires/base/check.h"
#include "imagination/answer/fewest_rollouts.h"

namespace hires::imagination {
namespace {

constexpr int kShares = 192, kNormals = 8;  // points of both distributions
constexpr double kFurthest = 5.0;           // standard deviations of the normal one
constexpr double kPi = 3.14159265358979323846;

struct Point {
  double cost;  // [s]
  std::size_t alternative;
  double weight;
  bool operator<(const Point& other) const { return cost < other.cost; }
};

double LogLikelihood(const CostPosterior& of, double p) {
  const double successes = of.rollouts - of.failures;
  return (of.failures > 0.0 ? of.failures * std::log(p) : 0.0) +
         (successes > 0.0 ? successes * std::log1p(-p) : 0.0);
}

/// Weighted points of the expected cost. With p = sin^2 t the density of a Jeffreys posterior is
/// its likelihood, smooth and with a standard deviation of 1 / (2 sqrt(n)) in t, so that few
/// equidistant points integrate it. Those of the normal distribution are shifted by golden
/// sections, so that all differ also where the penalty is 0.
void AddPoints(const CostPosterior& of, std::size_t alternative, std::vector<Point>* points) {
  const double mode = of.failures / of.rollouts, reach = 3.5 / std::sqrt(of.rollouts);
  const double middle = std::asin(std::sqrt(mode));
  const double low = std::max(0.0, middle - reach), high = std::min(0.5 * kPi, middle + reach);
  const std::size_t first = points->size();
  double sum = 0.0;
  for (int i = 0; i < kShares; ++i) {
    const double share = std::pow(std::sin(low + (high - low) * (i + 0.5) / kShares), 2);
    const double weight = std::exp(LogLikelihood(of, share) - LogLikelihood(of, mode));
    const double shift = std::fmod(i * 0.618033988749895, 1.0);
    for (int k = 0; k < kNormals; ++k) {
      const double z = kFurthest * (2.0 * (k + shift) / kNormals - 1.0);
      points->push_back({of.duration + of.duration_sd * z + of.penalty * share, alternative,
                         weight * std::exp(-0.5 * z * z)});
      sum += points->back().weight;
    }
  }
  for (std::size_t i = first; i < points->size(); ++i) (*points)[i].weight /= sum;
}

/// Probability that all others cost more, with these shares still to come of each.
double OthersAbove(const std::vector<double>& left, std::size_t alternative) {
  double product = 1.0;
  for (std::size_t i = 0; i < left.size(); ++i) product *= i == alternative ? 1.0 : left[i];
  return product;
}

}  // namespace

double CostPosterior::Variance() const {
  const double p = FailureProbability();
  return duration_sd * duration_sd + penalty * penalty * p * (1.0 - p) / (rollouts + 2.0);
}

BestOdds OddsOf(const std::vector<CostPosterior>& alternatives) {
  const std::size_t n = alternatives.size();
  HIRES_CHECK(n >= 1, "there is no alternative");
  if (n == 1) return {{1.0}, {0.0}};
  BestOdds odds{std::vector<double>(n, 0.0), std::vector<double>(n, 0.0)};
  std::vector<Point> points;
  for (std::size_t i = 0; i < n; ++i) AddPoints(alternatives[i], i, &points);
  std::stable_sort(points.begin(), points.end());
  // E[max(0, C - M)] is the integral over x of P(C > x) P(M < x) for independent C and M.
  std::vector<double> left(n, 1.0);
  for (auto next = points.begin(); next != points.end();) {
    const double x = next->cost;
    const std::vector<double> before = left;
    for (; next != points.end() && next->cost == x; ++next) {
      left[next->alternative] -= next->weight;
    }
    const double step = next == points.end() ? 0.0 : next->cost - x;
    for (std::size_t i = 0; i < n; ++i) {
      const double above = OthersAbove(left, i);
      // Of equals each is as likely the cheaper one.
      odds.probability[i] += (before[i] - left[i]) * 0.5 * (OthersAbove(before, i) + above);
      odds.regret[i] += std::max(0.0, step * left[i] * (1.0 - above));
    }
  }
  return odds;
}

std::vector<int> AllocateRound(const std::vector<CostPosterior>& alternatives, int best, int size,
                               const std::vector<int>& room) {
  const std::size_t n = alternatives.size(), first = static_cast<std::size_t>(best);
  std::vector<double> weight(n, 0.0);  // at first eta
  for (std::size_t i = 0; i < n; ++i) {
    const double spread = std::sqrt(alternatives[i].Variance() + alternatives[first].Variance());
    if (i == first || spread <= 0.0) continue;
    const double distance = (alternatives[i].Mean() - alternatives[first].Mean()) / spread;
    weight[i] = std::exp(-0.5 * distance * distance) / spread;
    weight[first] += weight[i];
  }
  double weights = 0.0, rollouts = size;
  for (std::size_t i = 0; i < n; ++i) {
    const CostPosterior& one = alternatives[i];
    weight[i] = room[i] > 0 ? std::sqrt(weight[i] * one.rollouts * one.Variance()) : 0.0;
    weights += weight[i];
    rollouts += room[i] > 0 ? one.rollouts : 0.0;
  }
  double wanted = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    // Where nothing differs, or nothing can turn, all get the same.
    if (weights > 0.0) weight[i] = rollouts * weight[i] / weights - alternatives[i].rollouts;
    weight[i] = room[i] > 0 ? std::max(weights > 0.0 ? 0.0 : 1.0, weight[i]) : 0.0;
    wanted += weight[i];
  }
  std::vector<int> round(n, 0);
  for (std::size_t i = 0; i < n && wanted > 0.0; ++i) {
    round[i] = std::min(room[i], static_cast<int>(std::ceil(size * weight[i] / wanted)));
  }
  return round;
}

std::optional<int> RolloutsToSettle(const std::vector<CostPosterior>& alternatives,
                                    double probability, int most) {
  double from = 1.0;
  for (const CostPosterior& one : alternatives) from = std::max(from, one.rollouts);
  return FewestRollouts(static_cast<int>(from), most, [&](int rollouts) {
    std::vector<CostPosterior> later = alternatives;
    for (CostPosterior& one : later) {
      one.failures *= rollouts / one.rollouts;
      one.duration_sd *= std::sqrt(one.rollouts / rollouts);
      one.rollouts = rollouts;
    }
    const std::vector<double> best = OddsOf(later).probability;
    return *std::max_element(best.begin(), best.end()) >= probability;
  });
}

}  // namespace hires::imagination
