#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hires/imagination/report.h"
#include "hires/imagination/rollout_recording.h"

namespace hires::imagination {

/// Which rollout of which alternative somebody wants to look at.
struct RolloutChoice {
  enum class Kind { kWorst, kMedian, kFirstFailed, kIndex };
  Kind kind{Kind::kWorst};
  int index{0};             ///< kIndex
  std::optional<int> rank;  ///< of the alternative in the ranking, from 1
};

/// "worst", "median", "first_fall" (the first that is no success) or a number from 0, and
/// optionally the alternative that it is of: "worst@3".
/// @throws base::ConfigError naming what came and what was wanted.
RolloutChoice ParseRolloutChoice(const std::string& text);

/// Refuses before anything is played what no answer could have.
/// @param num_rollouts  at most so many of each alternative.
/// @throws base::ConfigError for a rank beyond the alternatives or a number beyond the rollouts.
void RequireRollout(const RolloutChoice& choice, std::size_t num_alternatives, int num_rollouts);

struct PickedRollout {
  int rank{1};   ///< of its alternative, from 1
  int index{0};  ///< within the alternative
};

/// Largest tilt of one rollout [rad], found by playing it again.
using TiltOfRollout = std::function<double(const base::ActionCall& action, int index)>;

/// Finds the rollout. Without a rank `worst` is the one that leaned most among the failures of all
/// alternatives (of all rollouts where none failed; the better rank of equals), and any other is of
/// the first alternative.
/// @param tilt_of  asked of one rollout per alternative, for `worst` without a rank alone.
/// @throws base::ConfigError if there is no such alternative or rollout; where another alternative
/// has one, the message names it.
PickedRollout PickRollout(const RolloutChoice& choice, const std::vector<Prediction>& ranking,
                          const TiltOfRollout& tilt_of);
/// Asks the rollouts of this setup.  @pre `setup` stays.
TiltOfRollout TiltsIn(const RolloutSetup& setup);

/// Plays a rollout of the prediction again: it ends as it did when it was imagined.
/// @param watcher  of what is played; may be null.
/// @return nothing if it was cancelled.
/// @throws base::ConfigError if it is none of those that were imagined: workers with another build
/// or other files than this program.
std::optional<RolloutRecording> ReplayRollout(const RolloutSetup& setup,
                                              const Prediction& prediction, int index,
                                              const std::function<bool()>& cancelled,
                                              RolloutWatcher* watcher);

}  // namespace hires::imagination
