#include "hires/imagination/success_interval.h"

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

#include "hires/base/check.h"
#include "imagination/answer/confidence_sequence.h"
#include "imagination/answer/fewest_rollouts.h"

namespace hires::imagination {
namespace {

double BetaQuantile(double a, double b, double share) {
  return boost::math::quantile(boost::math::beta_distribution<>(a, b), share);
}

/// Ends of the interval that are not those of [0, 1].
struct Ends {
  double lower, upper;
};

Ends ClopperPearson(double successes, double failures, double alpha) {
  return {successes > 0.0 ? BetaQuantile(successes, failures + 1.0, alpha / 2.0) : 0.0,
          failures > 0.0 ? BetaQuantile(successes + 1.0, failures, 1.0 - alpha / 2.0) : 1.0};
}

double LogBeta(double a, double b) {
  return boost::math::lgamma(a) + boost::math::lgamma(b) - boost::math::lgamma(a + b);
}

/// Log of the mixture's likelihood ratio against the share p, less the log of 1 / alpha: positive
/// where p is out. Convex in p with its minimum, which is negative, at the observed share.
class LogRatio {
 public:
  LogRatio(double successes, double failures, double alpha)
      : successes_(successes),
        failures_(failures),
        log_mixture_(LogBeta(successes + 0.5, failures + 0.5) - LogBeta(0.5, 0.5) +
                     std::log(alpha)) {}

  double operator()(double p) const {
    const double log_success = successes_ > 0.0 ? successes_ * std::log(p) : 0.0;
    const double log_failure = failures_ > 0.0 ? failures_ * std::log1p(-p) : 0.0;
    return log_mixture_ - log_success - log_failure;
  }

  /// Between `out`, where it is positive, and `in`, where it is not.
  double Root(double out, double in) const {
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (out + in);
      ((*this)(middle) > 0.0 ? out : in) = middle;
    }
    return out;
  }

 private:
  double successes_, failures_, log_mixture_;
};

Ends ConfidenceSequence(double successes, double failures, double alpha) {
  const LogRatio ratio(successes, failures, alpha);
  const double share = successes / (successes + failures);
  return {successes > 0.0 ? ratio.Root(0.0, share) : 0.0,
          failures > 0.0 ? ratio.Root(1.0, share) : 1.0};
}

/// Whether `num_rollouts` with that rate take the interval off the wanted share.
bool Decides(double rate, int num_rollouts, IntervalKind kind, double min_success) {
  const int num_success = static_cast<int>(std::lround(rate * num_rollouts));
  return Judge(EstimateSuccess(num_success, num_rollouts, kind), min_success) != Suitability::kOpen;
}

}  // namespace

std::string ToString(IntervalKind kind) {
  return kind == IntervalKind::kClopperPearson ? "Clopper-Pearson" : "confidence sequence";
}

SuccessInterval EstimateSuccess(int num_success, int num_rollouts, IntervalKind kind,
                                double alpha) {
  HIRES_CHECK(num_success >= 0 && num_success <= num_rollouts,
              "there are more successes than rollouts, or fewer than none");
  if (num_rollouts == 0) return {0.0, 0.0, 1.0, 0, kind};
  const double failures = num_rollouts - num_success;
  const Ends ends = kind == IntervalKind::kClopperPearson
                        ? ClopperPearson(num_success, failures, alpha)
                        : ConfidenceSequence(num_success, failures, alpha);
  return {static_cast<double>(num_success) / num_rollouts, ends.lower, ends.upper, num_rollouts,
          kind};
}

Suitability Judge(const SuccessInterval& success, double min_success) {
  if (success.lower >= min_success) return Suitability::kReached;
  return success.upper < min_success ? Suitability::kNotReached : Suitability::kOpen;
}

std::optional<int> RolloutsToDecide(const SuccessInterval& success, double min_success, int most) {
  HIRES_CHECK(success.num_rollouts >= 1, "wanted at least one rollout to estimate from");
  HIRES_CHECK(min_success > 0.0 && min_success < 1.0, "min_success lies outside (0, 1)");
  return FewestRollouts(success.num_rollouts, most, [&](int rollouts) {
    return Decides(success.share, rollouts, success.kind, min_success);
  });
}

}  // namespace hires::imagination
