#pragma once

#include <optional>
#include <string>

namespace hires::imagination {

/// By what method an interval was made. Both kinds hold the truth with at least 95 %, whatever it
/// is.
enum class IntervalKind {
  /// Exact at one number of rollouts that was fixed before the first was played [Clopper, Pearson
  /// 1934, Biometrika 26:404-413].
  kClopperPearson,
  /// Valid at every number of rollouts at once, hence where one looks more than once, stops when
  /// he
  /// has seen enough, or is interrupted: the likelihood ratio of Jeffreys' beta mixture against a
  /// share of successes p is a martingale if p is true, so p is out once it exceeds 20 [Robbins
  /// 1970,
  /// Ann. Math. Stat. 41:1397-1409; Howard et al. 2021, Ann. Stat. 49:1055-1080].
  kConfidenceSequence
};

/// "Clopper-Pearson", "confidence sequence".
std::string ToString(IntervalKind kind);

/// How often an action succeeds, as far as counted rollouts tell. All shares lie in [0, 1].
struct SuccessInterval {
  double share{0.0};    ///< successful rollouts / all rollouts
  double lower{0.0};    ///< lower end of the 95 % interval
  double upper{1.0};    ///< upper end of the 95 % interval
  int num_rollouts{0};  ///< what the numbers rest on; 0 means "we know nothing yet"
  IntervalKind kind{IntervalKind::kConfidenceSequence};
};

constexpr double kAlpha = 0.05;  ///< chance that an interval of 95 % misses what it is about

/// @param alpha  chance that the interval misses the truth, in (0, 1).
/// @pre 0 <= num_success <= num_rollouts.  @throws std::logic_error if broken.
SuccessInterval EstimateSuccess(int num_success, int num_rollouts, IntervalKind kind,
                                double alpha = kAlpha);

/// What an interval says about a wanted share of successes.
enum class Suitability {
  kReached,    ///< the lower end reaches it
  kOpen,       ///< the interval holds it: more rollouts may decide
  kNotReached  ///< the upper end lies below it
};
Suitability Judge(const SuccessInterval& success, double min_success);

/// About how many rollouts in all would take an interval off `min_success` if successes went on at
/// the rate seen so far; none: more than `most`.
/// @pre success.num_rollouts >= 1, 0 < min_success < 1.  @throws std::logic_error if broken.
std::optional<int> RolloutsToDecide(const SuccessInterval& success, double min_success, int most);

}  // namespace hires::imagination
