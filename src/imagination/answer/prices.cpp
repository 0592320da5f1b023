#include "hires/imagination/prices.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"
#include "hires/base/log.h"
#include "hires/base/text.h"
#include "imagination/answer/confidence_sequence.h"

namespace hires::imagination {
namespace {

std::vector<std::string> WordsThatEndRollouts() {
  std::vector<std::string> words;
  for (const base::FailureInfo& info : base::AllFailures()) {
    if (EndsRollouts(info.code)) words.push_back(info.word);
  }
  return words;
}

base::FailureCode CodeAt(const base::ParamReader& in, const std::string& word) {
  const auto code = base::ParseFailureCode(word);
  if (!code) in.Fail(word, base::UnknownName("failure code", word, WordsThatEndRollouts()));
  if (!EndsRollouts(*code)) {
    in.Fail(word, "no imagined rollout ends with this code; take the line out");
  }
  return *code;
}

/// Of the error probability of a cost interval; the rest is for the mean duration, which is known
/// better.
constexpr double kFailureAlpha = 0.8 * kAlpha;
/// Up to so many failures the interval of their probability is narrower than a MeanSequence.
constexpr int kFewFailures = 3;

/// Half width of the asymptotic confidence sequence of a mean, narrowest at 32 values.
double HalfWidth(double deviation, double count) {
  const double alpha = kAlpha - kFailureAlpha;
  const double rho2 = (-2.0 * std::log(alpha) + std::log(1.0 - 2.0 * std::log(alpha))) / 32.0;
  const double wide = count * rho2 + 1.0;
  return deviation *
         std::sqrt(2.0 * wide / (count * count * rho2) * std::log(std::sqrt(wide) / alpha));
}

/// [s] of a failure that was not seen: dropping the payload, or `other` without one.
double UnseenPenalty(bool carries_payload, const Prices& prices) {
  return PriceOf(carries_payload ? base::FailureCode::kObjectFell : base::FailureCode::kOther,
                 prices);
}

}  // namespace

double Prices::Highest() const {
  double highest = 0.0;
  for (const auto& [code, price] : of) highest = std::max(highest, price);
  return CostOfTime(time_limit, *this) + highest;
}

bool EndsRollouts(base::FailureCode code) {
  const auto number = static_cast<int>(code);
  return (number > 0 && number < 200) || number >= 400;
}

Prices ReadPrices(base::ParamReader in) {
  Prices prices;
  prices.late = in.Get("late", base::Between(0.0, kHighestPrice));
  prices.not_done = in.Get("not_done", base::Between(0.0, kHighestPrice));
  for (const std::string& word : in.Keys()) {
    if (word == "late" || word == "not_done") continue;
    prices.of[CodeAt(in, word)] = in.Get(word, base::Between(0.0, kHighestPrice));
  }
  for (const base::FailureInfo& info : base::AllFailures()) {
    if (info.code == base::FailureCode::kRobotTips && prices.of.count(info.code) == 0) {
      prices.of[info.code] = kPenaltyOfTipping;
      base::Log(base::LogLevel::kWarn,
                fmt::format("penalties: the file has none for {0}; {1:g} s is used. Add the line "
                            "'{0}: {1:.1f}' to it",
                            info.word, kPenaltyOfTipping));
    }
    if (EndsRollouts(info.code) && prices.of.count(info.code) == 0) {
      in.Fail(info.word, fmt::format("it has no price; give one between 0 and {} s, and its reason "
                                     "as a comment",
                                     kHighestPrice));
    }
  }
  return prices;
}

Prices Scaled(Prices prices, double factor) {
  HIRES_CHECK(factor >= 0.0, "nothing costs less than nothing");
  for (auto& [code, price] : prices.of) price *= factor;
  prices.late *= factor;
  prices.not_done *= factor;
  return prices;
}

double CostOfTime(double duration, const Prices& prices) {
  const double time = std::min(duration, prices.time_limit);
  return time + prices.late * std::max(0.0, time - prices.deadline);
}

double PriceOf(base::FailureCode code, const Prices& prices) {
  HIRES_CHECK(!prices.empty(), "nothing is priced");
  if (code == base::FailureCode::kNone) return 0.0;
  const auto price = prices.of.find(code);
  return price != prices.of.end() ? price->second : prices.of.at(base::FailureCode::kOther);
}

double CostOf(const RolloutResult& result, const Prices& prices) {
  return CostOfTime(result.duration, prices) + PriceOf(FailureOf(result).code, prices);
}

double PseudoPenalty(const std::vector<RolloutPrefix>& request, const Prices& prices) {
  double sum = 0.0;
  int failures = 0;
  bool carries_payload = false;
  for (const RolloutPrefix& of_one : request) {
    for (int i = 0; i < of_one.num_rollouts; ++i) {
      const RolloutResult& result = (*of_one.results)[static_cast<std::size_t>(i)];
      const base::FailureCode code = FailureOf(result).code;
      carries_payload = carries_payload || !result.nothing_watched;
      failures += code != base::FailureCode::kNone;
      sum += PriceOf(code, prices);
    }
  }
  return failures > 0 ? sum / failures : UnseenPenalty(carries_payload, prices);
}

std::optional<ExpectedCost> EstimateCost(const RolloutPrefix& rollouts, const Prices& prices,
                                         double pseudo_penalty, IntervalKind kind) {
  const int n = rollouts.num_rollouts;
  if (prices.empty() || n == 0) return std::nullopt;
  double sum = 0.0, square_sum = 0.0, shortest = prices.Highest(), penalties = pseudo_penalty;
  double dearest = 0.0;
  int failures = 0, num_dearest = 0;
  bool carries_payload = false;
  MeanSequence sequence(0.0, prices.Highest(), kAlpha);
  for (int i = 0; i < n; ++i) {
    const RolloutResult& result = (*rollouts.results)[static_cast<std::size_t>(i)];
    const double duration = CostOfTime(result.duration, prices);
    sum += duration;
    square_sum += duration * duration;
    shortest = std::min(shortest, duration);
    carries_payload = carries_payload || !result.nothing_watched;
    sequence.Add(CostOf(result, prices));
    const base::FailureCode code = FailureOf(result).code;
    if (code == base::FailureCode::kNone) continue;
    const double penalty = PriceOf(code, prices);
    ++failures;
    penalties += penalty;
    num_dearest = penalty > dearest ? 1 : num_dearest + (penalty == dearest);
    dearest = std::max(dearest, penalty);
  }
  const double mean = sum / n;
  // Nothing is known of the deviation of one value: the value itself stands for it.
  const double deviation =
      n == 1 ? mean : std::sqrt(std::max(0.0, square_sum - sum * mean) / (n - 1));
  const CostPosterior posterior{mean, deviation / std::sqrt(n), penalties / (failures + 1),
                                1.0 * failures, 1.0 * n};
  const double cost = posterior.Mean(), unseen = UnseenPenalty(carries_payload, prices);
  const bool cost_alike = num_dearest == failures && (failures == 0 || dearest >= unseen);
  if (cost_alike && failures <= kFewFailures) {
    const double penalty = std::max(dearest, unseen), half = HalfWidth(deviation, n);
    const auto success = EstimateSuccess(n - failures, n, kind, kFailureAlpha);
    const double lower = std::max(mean - half, shortest) + (1.0 - success.upper) * penalty;
    const double upper = std::min(mean + half, CostOfTime(prices.time_limit, prices)) +
                         (1.0 - success.lower) * penalty;
    return ExpectedCost{cost, std::min(cost, lower), std::max(cost, upper), posterior};
  }
  const Interval bounds = sequence.Bounds();
  return ExpectedCost{cost, std::min(cost, std::max(shortest, bounds.lower)),
                      std::max(cost, bounds.upper), posterior};
}

}  // namespace hires::imagination
