#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hires/imagination/rollout_reach.h"

namespace hires::loop {

/// Rollouts of all requests of a task, for requests that begin again because something changed:
/// what the change cannot have touched need not be played again.
class KeptRollouts {
 public:
  void Keep(const std::shared_ptr<const imagination::RolloutSetup>& setup,
            const base::ActionCall& action, int index, const imagination::ReachedRollout& rollout);

  /// What playing it from there gives, to the last bit; nothing if that is not certain.
  std::optional<imagination::ReachedRollout> Find(const imagination::RolloutSetup& now,
                                                  const base::ActionCall& action, int index) const;

 private:
  struct Kept {
    std::shared_ptr<const imagination::RolloutSetup> setup;
    imagination::ReachedRollout rollout;
  };
  std::map<std::pair<std::string, int>, std::vector<Kept>> kept_;  // by action and index
};

}  // namespace hires::loop
