#include "imagination/answer/confidence_sequence.h"

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"

namespace hires::imagination {
namespace {

/// Share of the wealth that may be lost in one play. Close to 1, because our variables hardly vary
/// (most rollouts of both alternatives succeed) and then the boldest bet is the best one.
constexpr double kBoldness = 0.9;

}  // namespace

MeanSequence::MeanSequence(double at_least, double at_most, double alpha)
    : at_least_(at_least), at_most_(at_most), log_threshold_(std::log(2.0 / alpha)) {
  HIRES_CHECK(std::isfinite(at_least) && std::isfinite(at_most) && at_least < at_most,
              "the range of a bounded variable is empty or not finite");
  HIRES_CHECK(alpha > 0.0 && alpha < 1.0, "an error probability lies outside (0, 1)");
}

void MeanSequence::Add(double value) {
  HIRES_CHECK(value >= at_least_ && value <= at_most_, "a value lies outside its range");
  const double scaled = Scaled(value);
  plays_.push_back({scaled, NextStake()});
  sum_ += scaled;
  const double mean = (0.5 + sum_) / (num_values() + 1.0);
  square_sum_ += (scaled - mean) * (scaled - mean);
}

bool MeanSequence::Above(double m) const {
  HIRES_CHECK(m >= at_least_ && m <= at_most_, "a mean lies outside its range");
  return LogWealth(Scaled(m), false) >= log_threshold_;
}

bool MeanSequence::Below(double m) const {
  HIRES_CHECK(m >= at_least_ && m <= at_most_, "a mean lies outside its range");
  return LogWealth(Scaled(m), true) >= log_threshold_;
}

Interval MeanSequence::Bounds() const {
  const double width = at_most_ - at_least_;
  return {at_least_ + width * RuledOutUpTo(false), at_most_ - width * RuledOutUpTo(true)};
}

double MeanSequence::NextStake() const {
  const double t = num_values() + 1.0;
  const double variance = (0.25 + square_sum_) / t;
  return std::sqrt(2.0 * log_threshold_ / (variance * t * std::log(t + 1.0)));
}

double MeanSequence::LogWealth(double scaled_m, bool mirrored) const {
  const double m = mirrored ? 1.0 - scaled_m : scaled_m;
  const double largest_stake = kBoldness / m;  // infinite at m = 0, where nothing can be lost
  double log_wealth = 0.0;
  for (const Play& play : plays_) {
    const double value = mirrored ? 1.0 - play.value : play.value;
    log_wealth += std::log1p(std::min(play.stake, largest_stake) * (value - m));
  }
  return log_wealth;
}

double MeanSequence::RuledOutUpTo(bool mirrored) const {
  double ruled_out = 0.0;
  double possible = 1.0;
  while (possible - ruled_out > 1e-9) {
    const double middle = 0.5 * (ruled_out + possible);
    const bool is_out = LogWealth(mirrored ? 1.0 - middle : middle, mirrored) >= log_threshold_;
    (is_out ? ruled_out : possible) = middle;
  }
  return ruled_out;
}

}  // namespace hires::imagination
