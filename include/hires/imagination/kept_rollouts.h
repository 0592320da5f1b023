#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hires/imagination/rollout.h"
#include "hires/imagination/scheduler.h"

namespace hires::imagination {

/// What PlayRollout gives for the same action and index from another start, if that is certain from
/// what it gave for the first: nothing that the rollout depends on differs, in either start.
/// @pre both were made from one ImaginationSetup; `now` was checked (CheckSetup)
std::optional<RolloutResult> ResultFrom(const RolloutSetup& played, const RolloutResult& result,
                                        const base::ActionCall& action, const RolloutSetup& now);

/// Rollouts of earlier requests, for requests that begin again because something changed: what the
/// change cannot have touched need not be played again.
class KeptRollouts {
 public:
  /// @param most  so many are kept; then the oldest is forgotten. 0: none.
  explicit KeptRollouts(int most) : most_(static_cast<std::size_t>(most)) {}

  /// One that is kept already for this very setup is not kept twice.
  void Keep(const std::shared_ptr<const RolloutSetup>& setup, const base::ActionCall& action,
            int index, const RolloutResult& result);

  /// What playing it from there gives, to the last bit; nothing if that is not certain.
  std::optional<RolloutResult> Find(const RolloutSetup& now, const base::ActionCall& action,
                                    int index) const;

  /// What of an assignment need not be played.
  struct Shortened {
    std::vector<RolloutFinished> known;  ///< in order of their indices
    Assign rest;                         ///< from the first to the last that is not; count 0: none
  };
  Shortened Shorten(const Assign& assign, const RolloutSetup& now,
                    const base::ActionCall& action) const;

 private:
  struct Kept {
    std::shared_ptr<const RolloutSetup> setup;
    RolloutResult result;
  };
  using Key = std::pair<std::string, int>;  // action and index

  std::size_t most_;
  std::map<Key, std::deque<Kept>> kept_;
  std::deque<Key> order_;  // as they were kept
};

}  // namespace hires::imagination
