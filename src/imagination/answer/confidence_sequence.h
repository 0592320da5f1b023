#pragma once

#include <vector>

namespace hires::imagination {

/// A two-sided interval; both ends lie in the range of the variable.
struct Interval {
  double lower{0.0};
  double upper{0.0};
};

/// What is known about the mean of a bounded variable after its first n values, for somebody who
/// looks as often as he likes: with probability 1 - alpha the intervals after n = 1, 2, 3, ... all
/// hold the mean at once. The values must come one after the other with the same mean given the
/// past (rollouts with forked seeds do); nothing else is asked of their distribution.
///
/// Method: the hedged capital of [Waudby-Smith, Ramdas 2024, J. R. Stat. Soc. B 86:1-27]: two
/// gamblers bet against "the mean is m", one that it is higher, one that it is lower; m is ruled
/// out once half the wealth of one of them has reached 1 / alpha. Their bets follow the variance
/// seen so far, so the interval narrows fast for values that hardly vary. It has no closed form,
/// but is an interval, because each wealth is monotone in m.
class MeanSequence {
 public:
  /// @param at_least, at_most  the range of the variable.  @param alpha  in (0, 1).
  /// @pre at_least < at_most, all finite.  @throws std::logic_error if broken.
  MeanSequence(double at_least, double at_most, double alpha);

  /// @pre value lies in the range.  @throws std::logic_error if broken (or not a number).
  void Add(double value);

  bool Above(double m) const;  ///< the mean is certainly higher than m.  @pre m in the range
  bool Below(double m) const;  ///< the mean is certainly lower than m.  @pre m in the range

  /// All means that are not ruled out, to 1e-9 of the range; the whole range before the first
  /// value. Values that contradict any single mean (within the unlucky share alpha) give lower >
  /// upper.
  Interval Bounds() const;

  int num_values() const { return static_cast<int>(plays_.size()); }

 private:
  /// One value, scaled to [0, 1], and the stake that was fixed before it was seen.
  struct Play {
    double value;
    double stake;
  };
  double Scaled(double x) const { return (x - at_least_) / (at_most_ - at_least_); }
  double NextStake() const;
  /// Log wealth of the gambler on "higher than m"; on "lower" when both are mirrored at 1/2.
  double LogWealth(double scaled_m, bool mirrored) const;
  double RuledOutUpTo(bool mirrored) const;

  double at_least_;
  double at_most_;
  double log_threshold_;  // ln(2 / alpha)
  double sum_{0.0};
  double square_sum_{0.0};  // of deviations from the running mean
  std::vector<Play> plays_;
};

}  // namespace hires::imagination
