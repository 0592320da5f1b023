#include "hires/imagination/prices.h"

#include <fmt/format.h>

#include <algorithm>

#include "hires/base/check.h"
#include "hires/base/log.h"
#include "hires/base/text.h"
#include "hires/imagination/success_interval.h"
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

std::optional<ExpectedCost> EstimateCost(const std::vector<RolloutResult>& results,
                                         int num_rollouts, const Prices& prices) {
  HIRES_CHECK(num_rollouts >= 0 && num_rollouts <= static_cast<int>(results.size()),
              "there are not that many rollouts to sum up");
  if (prices.empty() || num_rollouts == 0) return std::nullopt;
  MeanSequence sequence(0.0, prices.Highest(), kAlpha);
  double sum = 0.0;
  for (int i = 0; i < num_rollouts; ++i) {
    const double cost = CostOf(results[i], prices);
    sequence.Add(cost);
    sum += cost;
  }
  const double mean = sum / num_rollouts;
  const Interval bounds = sequence.Bounds();
  // Rounding, and sequences that contradict every mean, must not put the mean outside.
  return ExpectedCost{mean, std::min(mean, bounds.lower), std::max(mean, bounds.upper)};
}

}  // namespace hires::imagination
