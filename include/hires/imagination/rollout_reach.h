#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "hires/imagination/rollout.h"

namespace hires::imagination {

/// Which part of the room a rollout depends on: what stands apart from all of its discs was left
/// out of it, wherever it stood, and so cannot have changed it.
struct RolloutReach {
  struct Disc {
    Eigen::Vector2d p_M;  ///< [m]
    double radius;        ///< [m]
  };
  bool is_everything{true};  ///< nothing was left out
  std::vector<Disc> discs;   ///< seen from above; heights do not matter

  /// Whether a disc touches one of them.
  bool Touches(const Disc& other) const;
};

/// A rollout and what it depends on.
struct ReachedRollout {
  RolloutResult result;
  RolloutReach reach;
};

/// PlayRollout, with what stands about left out of physics until something comes near it; then the
/// rollout begins again with it. So what was left out stands to the last bit as it did at the start
/// and has changed nothing: what is far away does not settle, and a step that the solver has to
/// repeat is not repeated for it. Actions that move arms or head, which look at objects, and starts
/// that cannot be are played with everything.
/// @pre CheckSetup; then what stands about stands apart from each other and from furniture.
/// Hooks are called by each beginning.
std::optional<ReachedRollout> PlayWithReach(const RolloutSetup& setup,
                                            const base::ActionCall& action, int index,
                                            const RolloutHooks& hooks = {});

/// What PlayWithReach gives for the same action and index from another start, if that is certain
/// from what it gave for the first: nothing that the rollout depends on differs, in either start.
/// @pre both were made from one ImaginationSetup; `now` was checked (CheckSetup)
std::optional<ReachedRollout> ResultFrom(const RolloutSetup& played, const ReachedRollout& rollout,
                                         const base::ActionCall& action, const RolloutSetup& now);

}  // namespace hires::imagination
