#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lab/src/ladder/places.h"

namespace hires::lab::ladder {

/// A step of the dissertation, ready to be measured. Its report is filled but for the numbers.
struct RungPlan {
  LadderRung rung;
  Way before, after;
  bool on_all_cores{false};
  bool is_one_motion{false};  ///< both ways play the same motion, so their ends can be compared
  double share{1.0};          ///< of the time that there is
};

/// All of section 5.4.2, in the order in which they are told there.
/// @param play_task  as in LadderOrder; empty: no rung of the whole system.
std::vector<RungPlan> DissertationRungs(
    const Places& places,
    const std::function<std::optional<double>(std::uint64_t seed)>& play_task);

}  // namespace hires::lab::ladder
