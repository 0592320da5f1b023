#include "lab/src/decision/calibration.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

#include "hires/base/check.h"

namespace hires::lab {
namespace {

constexpr double kBandTail = 0.025;

/// Forecasts by bins of equal width.
std::vector<std::vector<Forecast>> InBins(const std::vector<Forecast>& forecasts, int num_bins) {
  HIRES_CHECK(num_bins >= 1, "there is no bin");
  std::vector<std::vector<Forecast>> bins(static_cast<std::size_t>(num_bins));
  for (const Forecast& forecast : forecasts) {
    HIRES_CHECK(forecast.probability >= 0.0 && forecast.probability <= 1.0,
                "a forecast is no probability");
    const int bin = std::min(num_bins - 1, static_cast<int>(forecast.probability * num_bins));
    bins[static_cast<std::size_t>(bin)].push_back(forecast);
  }
  return bins;
}

double MeanForecast(const std::vector<Forecast>& forecasts) {
  double sum = 0.0;
  for (const Forecast& forecast : forecasts) sum += forecast.probability;
  return sum / static_cast<double>(forecasts.size());
}

int NumCame(const std::vector<Forecast>& forecasts) {
  return static_cast<int>(
      std::count_if(forecasts.begin(), forecasts.end(), [](const Forecast& f) { return f.came; }));
}

double ShareCame(const std::vector<Forecast>& forecasts) {
  return NumCame(forecasts) / static_cast<double>(forecasts.size());
}

double Square(double x) { return x * x; }

/// Sum over one bin of what its forecasts differ among themselves.
double WithinOf(const std::vector<Forecast>& bin) {
  const double mean = MeanForecast(bin), share = ShareCame(bin);
  double sum = 0.0;
  for (const Forecast& f : bin) {
    const double deviation = f.probability - mean;
    sum += deviation * deviation - 2.0 * deviation * ((f.came ? 1.0 : 0.0) - share);
  }
  return sum;
}

/// The numbers between which a count lies with 95 %, each tail at most 2.5 %.
std::pair<int, int> Middle(const std::vector<double>& distribution) {
  int lower = 0, upper = static_cast<int>(distribution.size()) - 1;
  for (double tail = distribution[0]; tail <= kBandTail && lower < upper;) {
    tail += distribution[static_cast<std::size_t>(++lower)];
  }
  for (double tail = distribution.back(); tail <= kBandTail && upper > lower;) {
    tail += distribution[static_cast<std::size_t>(--upper)];
  }
  return {lower, upper};
}

ReliabilityBin BinOf(const std::vector<Forecast>& forecasts) {
  ReliabilityBin bin;
  bin.count = static_cast<int>(forecasts.size());
  bin.came = NumCame(forecasts);
  bin.forecast = MeanForecast(forecasts);
  bin.share = ShareCame(forecasts);
  std::vector<double> probabilities;
  for (const Forecast& forecast : forecasts) probabilities.push_back(forecast.probability);
  const auto [lower, upper] = Middle(PoissonBinomial(probabilities));
  bin.band_lower = static_cast<double>(lower) / bin.count;
  bin.band_upper = static_cast<double>(upper) / bin.count;
  return bin;
}

double TwoSidedNormal(double z) {
  return 2.0 * boost::math::cdf(boost::math::complement(boost::math::normal(), std::abs(z)));
}

/// The doubled smaller tail of a count, at most 1.
double TwoSided(const std::vector<double>& distribution, int count) {
  double below = 0.0, above = 0.0;
  for (int i = 0; i < static_cast<int>(distribution.size()); ++i) {
    const double p = distribution[static_cast<std::size_t>(i)];
    if (i <= count) below += p;
    if (i >= count) above += p;
  }
  return std::min(1.0, 2.0 * std::min(below, above));
}

/// Chance that Kolmogorov's statistic exceeds x.
double KolmogorovTail(double x) {
  if (x < 0.2) return 1.0;  // less than 1e-12 is missing
  double sum = 0.0;
  for (int k = 1; k <= 100; ++k) sum += (k % 2 == 1 ? 2.0 : -2.0) * std::exp(-2.0 * k * k * x * x);
  return std::clamp(sum, 0.0, 1.0);
}

}  // namespace

BrierParts Brier(const std::vector<Forecast>& forecasts, int num_bins) {
  const auto bins = InBins(forecasts, num_bins);
  BrierParts parts;
  if (forecasts.empty()) return parts;
  const double n = static_cast<double>(forecasts.size()), share = ShareCame(forecasts);
  for (const Forecast& f : forecasts) {
    parts.score += Square(f.probability - (f.came ? 1.0 : 0.0)) / n;
  }
  for (const std::vector<Forecast>& bin : bins) {
    if (bin.empty()) continue;
    const double weight = static_cast<double>(bin.size()) / n;
    parts.reliability += weight * Square(MeanForecast(bin) - ShareCame(bin));
    parts.resolution += weight * Square(ShareCame(bin) - share);
    parts.within += WithinOf(bin) / n;
  }
  parts.uncertainty = share * (1.0 - share);
  return parts;
}

std::vector<ReliabilityBin> ReliabilityDiagram(const std::vector<Forecast>& forecasts,
                                               int num_bins) {
  const auto bins = InBins(forecasts, num_bins);
  std::vector<ReliabilityBin> diagram;
  for (int i = 0; i < num_bins; ++i) {
    const std::vector<Forecast>& in_bin = bins[static_cast<std::size_t>(i)];
    if (in_bin.empty()) continue;
    ReliabilityBin bin = BinOf(in_bin);
    bin.lower = static_cast<double>(i) / num_bins;
    bin.upper = static_cast<double>(i + 1) / num_bins;
    diagram.push_back(bin);
  }
  return diagram;
}

std::vector<double> PoissonBinomial(const std::vector<double>& probabilities) {
  std::vector<double> distribution{1.0};
  for (const double p : probabilities) {
    distribution.push_back(0.0);
    for (std::size_t k = distribution.size() - 1; k > 0; --k) {
      distribution[k] = distribution[k] * (1.0 - p) + distribution[k - 1] * p;
    }
    distribution[0] *= 1.0 - p;
  }
  return distribution;
}

TestResult SpiegelhalterTest(const std::vector<Forecast>& forecasts) {
  double sum = 0.0, variance = 0.0;
  for (const Forecast& f : forecasts) {
    const double slope = 1.0 - 2.0 * f.probability;
    sum += ((f.came ? 1.0 : 0.0) - f.probability) * slope;
    variance += slope * slope * f.probability * (1.0 - f.probability);
  }
  if (variance <= 0.0) return {};
  const double z = sum / std::sqrt(variance);
  return {z, TwoSidedNormal(z)};
}

TestResult ExchangeTest(const std::vector<Replayed>& events) {
  std::vector<double> probabilities;
  double expected = 0.0;
  int successes = 0;
  for (const Replayed& event : events) {
    HIRES_CHECK(event.num_success >= 0 && event.num_success <= event.num_rollouts,
                "there are more successes than rollouts, or fewer than none");
    const int all = event.num_success + (event.succeeded ? 1 : 0);
    probabilities.push_back(all / (event.num_rollouts + 1.0));
    expected += probabilities.back();
    successes += event.succeeded ? 1 : 0;
  }
  return {successes - expected, TwoSided(PoissonBinomial(probabilities), successes)};
}

double RandomisedPit(const std::vector<double>& samples, double value, base::Rng* rng) {
  const auto below =
      std::count_if(samples.begin(), samples.end(), [&](double s) { return s < value; });
  const auto equal = std::count(samples.begin(), samples.end(), value);
  const double place = rng->Uniform(0.0, static_cast<double>(equal) + 1.0);
  return (static_cast<double>(below) + place) / (static_cast<double>(samples.size()) + 1.0);
}

TestResult UniformTest(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const double n = static_cast<double>(values.size());
  double distance = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double rank = static_cast<double>(i);
    distance = std::max({distance, (rank + 1.0) / n - values[i], values[i] - rank / n});
  }
  const double root = std::sqrt(n);
  return {distance, KolmogorovTail(distance * (root + 0.12 + 0.11 / root))};
}

Interval PearsonCorrelation(const std::vector<double>& first, const std::vector<double>& second) {
  HIRES_CHECK(first.size() == second.size(), "there are not as many of one as of the other");
  const double mean_first = base::Mean(first), mean_second = base::Mean(second);
  double both = 0.0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    both += (first[i] - mean_first) * (second[i] - mean_second);
  }
  const double n = static_cast<double>(first.size());
  const double spread = n * Deviation(first) * Deviation(second);
  if (spread <= 0.0) return {0.0, -1.0, 1.0};
  const double r = std::clamp(both / spread, -1.0, 1.0);
  if (n <= 3.0) return {r, -1.0, 1.0};
  const double z =
      boost::math::quantile(boost::math::normal(), 1.0 - kBandTail) / std::sqrt(n - 3.0);
  return {r, std::tanh(std::atanh(r) - z), std::tanh(std::atanh(r) + z)};
}

double MeanMaximumRankViolation(const std::vector<double>& foretold,
                                const std::vector<double>& real) {
  HIRES_CHECK(foretold.size() == real.size(), "there are not as many of one as of the other");
  std::vector<double> largest(real.size(), 0.0);
  for (std::size_t i = 0; i < real.size(); ++i) {
    for (std::size_t j = 0; j < real.size(); ++j) {
      if ((foretold[i] < foretold[j]) == (real[i] < real[j])) continue;
      largest[i] = std::max(largest[i], std::abs(real[i] - real[j]));
    }
  }
  return base::Mean(largest);
}

}  // namespace hires::lab
