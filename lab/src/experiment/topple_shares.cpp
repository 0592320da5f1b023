#include "lab/src/experiment/topple_shares.h"

#include <utility>

#include "lab/src/statistics.h"

namespace hires::lab {
namespace {

using imagination::OutcomeCounts;

Interval IntervalOfShare(const ResampledCounts& set, const CountedEvent& event,
                         const CountRate& rate) {
  std::vector<double> shares;
  for (const LoopCounts& resample : set.resamples) {
    shares.push_back(ShareOf(resample.*rate.counts, event));
  }
  return PercentileInterval(ShareOf(set.all.*rate.counts, event), std::move(shares));
}

Interval IntervalOfRatio(const ResampledCounts& first, const ResampledCounts& second,
                         const CountedEvent& event, const CountRate& rate) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < first.resamples.size(); ++i) {
    ratios.push_back(
        RatioOf(first.resamples[i].*rate.counts, second.resamples[i].*rate.counts, event));
  }
  return PercentileInterval(RatioOf(first.all.*rate.counts, second.all.*rate.counts, event),
                            std::move(ratios));
}

}  // namespace

LoopCounts& LoopCounts::operator+=(const LoopCounts& other) {
  at_20hz += other.at_20hz;
  at_10hz += other.at_10hz;
  return *this;
}

double ShareOf(const OutcomeCounts& counts, const CountedEvent& event) {
  return static_cast<double>(counts.*event.count) / counts.total();
}

double RatioOf(const OutcomeCounts& first, const OutcomeCounts& second, const CountedEvent& event) {
  return ShareOf(first, event) / ShareOf(second, event);
}

std::string ShareName(const CountedEvent& event, const std::string& motion_set,
                      const CountRate& rate) {
  return std::string(event.name) + "_share_" + motion_set + rate.suffix;
}

std::string RatioName(const CountedEvent& event, const CountRate& rate) {
  return std::string(event.name) + "_ratio" + rate.suffix;
}

std::vector<LoopCounts> IndependentParts(const ToppleLoopConfig& loop,
                                         const std::vector<std::vector<Leg>>& chains) {
  std::vector<LoopCounts> parts;
  for (const std::vector<Leg>& chain : chains) {
    const std::size_t legs_per_part = loop.one_truth_per_chain ? chain.size() : loop.route.size();
    for (std::size_t i = 0; i < chain.size(); ++i) {
      if (i % legs_per_part == 0) parts.emplace_back();
      parts.back() += {chain[i].result.counts, chain[i].counts_10hz};
    }
  }
  return parts;
}

ResampledCounts Resample(const std::vector<LoopCounts>& parts, base::Rng rng) {
  constexpr int kResamples = 2000;
  ResampledCounts resampled;
  resampled.num_parts = parts.size();
  resampled.resamples.resize(kResamples);
  for (const LoopCounts& part : parts) resampled.all += part;
  const int num = static_cast<int>(parts.size());
  for (LoopCounts& sum : resampled.resamples) {
    for (int i = 0; i < num; ++i) sum += parts[rng.Index(num)];
  }
  return resampled;
}

std::vector<NamedInterval> LoopIntervals(const ToppleLoopConfig& loop,
                                         const std::vector<ResampledCounts>& sets) {
  std::vector<NamedInterval> intervals;
  for (const CountRate& rate : kCountRates) {
    for (const CountedEvent& event : kCountedEvents) {
      for (int s = 0; s < 2; ++s) {
        intervals.push_back(
            {ShareName(event, loop.motion_sets[s], rate), IntervalOfShare(sets[s], event, rate)});
      }
      intervals.push_back({RatioName(event, rate), IntervalOfRatio(sets[0], sets[1], event, rate)});
    }
  }
  return intervals;
}

}  // namespace hires::lab
