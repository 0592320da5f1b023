#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lab/src/experiment/chain.h"
#include "hires/base/rng.h"
#include "lab/src/experiment/experiment.h"
#include "lab/src/experiment/report.h"
#include "hires/imagination/rollout_result.h"

// Shares of the three kinds of samples in a `topple_loop`, and how sure they are.
namespace hires::lab {

/// The same samples, counted at both rates.
struct LoopCounts {
  imagination::OutcomeCounts at_20hz;
  imagination::OutcomeCounts at_10hz;  ///< every other sample

  LoopCounts& operator+=(const LoopCounts& other);
};

/// A rate of counting, and what names of measures end with.
struct CountRate {
  const char* title;
  const char* suffix;
  imagination::OutcomeCounts LoopCounts::*counts;
};
constexpr CountRate kCountRates[] = {{"20 Hz", "", &LoopCounts::at_20hz},
                                     {"10 Hz", "_10hz", &LoopCounts::at_10hz}};

/// The three kinds of samples, by name.
struct CountedEvent {
  const char* name;
  int imagination::OutcomeCounts::*count;
};
constexpr CountedEvent kCountedEvents[] = {{"notopple", &imagination::OutcomeCounts::notopple},
                                           {"shaking", &imagination::OutcomeCounts::shaking},
                                           {"topple", &imagination::OutcomeCounts::topple}};

/// Samples of this kind / all; no number where there are none.
double ShareOf(const imagination::OutcomeCounts& counts, const CountedEvent& event);
/// The first set's share / the second's; infinite where only the second has no such sample.
double RatioOf(const imagination::OutcomeCounts& first, const imagination::OutcomeCounts& second,
               const CountedEvent& event);

// Names of measures and of their intervals: "topple_share_slow_10hz", "topple_ratio_10hz".
std::string ShareName(const CountedEvent& event, const std::string& motion_set,
                      const CountRate& rate);
std::string RatioName(const CountedEvent& event, const CountRate& rate);

/// The independent parts of what one motion set played. With `truth_per: leg` a part is a round of
/// the route: mass, friction and late cycles are drawn for each leg, and only the places of robot
/// and load go from one leg to the next; all rounds have the same legs, which single legs have not.
/// With `truth_per: chain` all legs of a chain share what was drawn, and a part is a chain. The
/// last round of a chain may be cut off.
std::vector<LoopCounts> IndependentParts(const ToppleLoopConfig& loop,
                                         const std::vector<std::vector<Leg>>& chains);

/// What a motion set counted in all, and in each resample of its parts.
struct ResampledCounts {
  std::size_t num_parts{0};
  LoopCounts all;
  std::vector<LoopCounts> resamples;
};

/// 2000 resamples: as many parts as there are, drawn with replacement [Efron 1979, Ann. Stat.
/// 7:1-26]. Without parts all counts are 0.
ResampledCounts Resample(const std::vector<LoopCounts>& parts, base::Rng rng);

/// 95 % intervals (PercentileInterval) of all shares of both sets and of their ratios, at both
/// rates. Each set is resampled for itself: that leg i of chain k has the same truth in both sets
/// is not used, and makes intervals of the ratios too wide rather than too narrow. An event that
/// never came has the share 0 (0 .. 0): how rare it is cannot be told by resampling.
/// @param sets  the two motion sets, in the order of the configuration.
std::vector<NamedInterval> LoopIntervals(const ToppleLoopConfig& loop,
                                         const std::vector<ResampledCounts>& sets);

}  // namespace hires::lab
