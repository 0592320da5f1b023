#pragma once

#include <vector>

#include "hires/base/rng.h"
#include "lab/src/statistics.h"

// How well probabilities that were said beforehand fit what came.
namespace hires::lab {

/// What was said of an event, and whether it came.
struct Forecast {
  double probability{0.0};  ///< in [0, 1]
  bool came{false};
};

/// Brier's score, the mean of (probability - came)^2, and its parts by bins of equal width [Murphy
/// 1973, J. Appl. Meteorol. 12:595-600]. Forecasts of one bin differ, which adds a part of its own
/// [Stephenson, Coelho, Jolliffe 2008, Weather Forecast. 23:752-757], so that
/// score = reliability - resolution + uncertainty + within.
struct BrierParts {
  double score{0.0};
  double reliability{0.0};  ///< squared distance of share and forecast, by bin; 0 is best
  double resolution{0.0};   ///< squared distance of a bin's share from that of all; high is good
  double uncertainty{0.0};  ///< of the event itself
  double within{0.0};       ///< variance of forecasts in a bin less twice their covariance
};
/// @pre num_bins >= 1.  All 0 for no forecast.
BrierParts Brier(const std::vector<Forecast>& forecasts, int num_bins);

/// One point of a reliability diagram.
struct ReliabilityBin {
  double lower{0.0}, upper{0.0};  ///< [lower, upper); the last one has its upper end, too
  int count{0};                   ///< forecasts
  int came{0};
  double forecast{0.0};  ///< mean of the forecasts
  double share{0.0};     ///< came / count
  /// Between these the share lies with 95 % where the forecasts are right: consistency bars
  /// [Broecker, Smith 2007, Weather Forecast. 22:651-661], exact as the forecasts are taken as they
  /// are.
  double band_lower{0.0}, band_upper{1.0};
};
/// Empty bins are left out.  @pre num_bins >= 1.
std::vector<ReliabilityBin> ReliabilityDiagram(const std::vector<Forecast>& forecasts,
                                               int num_bins);

/// How likely 0, 1, ... n of n independent events come, with a probability each.
std::vector<double> PoissonBinomial(const std::vector<double>& probabilities);

struct TestResult {
  double statistic{0.0};
  double p_value{1.0};  ///< two-sided
};

/// Whether forecasts fit what came [Spiegelhalter 1986, Stat. Med. 5:421-433]: z of Brier's score,
/// normal for many forecasts. It takes each forecast for itself; Hosmer's and Lemeshow's test needs
/// groups, and most of ours say nearly 1, so that groups would be ties. No statistic where
/// every forecast is 0, 1/2 or 1: p is 1.
TestResult SpiegelhalterTest(const std::vector<Forecast>& forecasts);

/// An event that was foretold by so many plays of it.
struct Replayed {
  int num_success{0};
  int num_rollouts{0};
  bool succeeded{false};
};
/// Whether what happened could have been one more of the plays, exactly: of the num_rollouts + 1
/// the one that really happened is any, if they are of one kind, so that it is a success
/// with the share of successes among them all; the number of real successes then has the
/// distribution of PoissonBinomial. Unlike a test of shares it knows that shares are counted.
/// The statistic is the number of real successes less what was to be expected.
TestResult ExchangeTest(const std::vector<Replayed>& events);

/// Where a value lies among samples of what was foretold: (samples below + a random place among
/// its equals and itself) / (samples + 1), uniform on [0, 1) if it could be one of them.
double RandomisedPit(const std::vector<double>& samples, double value, base::Rng* rng);

/// Kolmogorov's and Smirnov's test of uniformity on [0, 1]; p by the asymptotic distribution with
/// Stephens's correction [1970, J. R. Stat. Soc. B 32:115-122]. p is 1 for no value.
TestResult UniformTest(std::vector<double> values);

/// Pearson's correlation with an interval by Fisher's transformation (n > 3, else -1 .. 1); 0 where
/// one of both does not vary.  @pre sizes agree.
Interval PearsonCorrelation(const std::vector<double>& first, const std::vector<double>& second);

/// Mean maximum rank violation [Li et al. 2024, arXiv:2405.05941, SIMPLER]: the mean over i of the
/// largest |real_i - real_j| over those j that both order differently, that is where
/// (foretold_i < foretold_j) != (real_i < real_j). 0 is best.  @pre sizes agree.
double MeanMaximumRankViolation(const std::vector<double>& foretold,
                                const std::vector<double>& real);

}  // namespace hires::lab
