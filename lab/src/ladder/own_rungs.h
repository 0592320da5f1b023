#pragma once

#include <functional>
#include <string>
#include <vector>

#include "lab/src/ladder/places.h"

namespace hires::lab::ladder {

/// A step of ours, ready to be measured.
struct OwnPlan {
  std::string id, title, unit;
  Way way;
  bool counts_seconds{false};  ///< [s] for each piece of work, not pieces in a second
  double share{0.5};           ///< of the time that there is
};

/// From one step of the engine to rollouts, one thread.
std::vector<OwnPlan> RolloutSteps(const Places& places);

/// Fast or slow with the pepper mill on the tray: so many rollouts each, ranked.
OwnPlan RankedAnswer(const Places& places, int num_rollouts, int threads,
                     const std::function<bool()>& cancelled);

}  // namespace hires::lab::ladder
