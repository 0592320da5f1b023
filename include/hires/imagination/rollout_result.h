#pragma once

#include <cstdint>
#include <string>

#include "hires/base/failure.h"
#include "hires/imagination/rollout_reach.h"
#include "hires/robot/observation.h"
#include "hires/world/world.h"

namespace hires::imagination {

/// 20 Hz samples of the carried object by its tilt alpha (dissertation, Eq. 5.1): notopple
/// alpha <= 0.01 rad, topple alpha >= 0.5 rad, shaking between.
struct OutcomeCounts {
  int notopple{0};
  int shaking{0};
  int topple{0};

  int total() const { return notopple + shaking + topple; }
  OutcomeCounts& operator+=(const OutcomeCounts& other);
  bool operator==(const OutcomeCounts& other) const;
};

enum class Outcome { kSucceeded, kFailed, kTimedOut };

/// What one simulated play of an action from one start with one seed gave.
struct RolloutResult {
  Outcome outcome{Outcome::kFailed};
  base::Failure failure;  ///< why it did not succeed; nothing: it did, or it is unknown
  double duration{0.0};   ///< [s] simulated, of the action alone
  OutcomeCounts counts;
  int falls{0};             ///< events, not samples
  double max_tilt{0.0};     ///< [rad]
  std::string first_cause;  ///< what happened just before the object first left its rest; or empty
  bool action_finished{false};  ///< the action itself reached its goal, whatever fell
  /// The robot carried nothing and the action handled nothing: there are no samples to count, and
  /// its success is all the evidence there is.
  bool nothing_watched{false};
  world::WorldState final_world;
  robot::RobotState final_robot;
  double simulated{0.0};  ///< [s] of physics, settling included
  RolloutReach reach;     ///< what it depends on
};

/// Whether the action counts as failed: it did not reach its goal, or nothing was sampled while it
/// ran although something was carried or handled, so that Eq. 6.1 has nothing to speak about.
bool ActionFailed(const RolloutResult& result);

/// Why a rollout is no success; nothing if it is one. A result that calls itself succeeded although
/// its action is unfinished, something fell (object_fell) or nothing was sampled of what was to be
/// watched (no_samples) is none; one that failed without saying why timed out or failed otherwise.
base::Failure FailureOf(const RolloutResult& result);

/// What makes a result unusable as evidence (a number that is not finite or negative, samples of
/// nothing), in words for people; empty if it is sound. Results come from other computers: look
/// before counting.
std::string Defect(const RolloutResult& result);

/// Whether two plays of one rollout gave the same to the last bit: everything that is counted; the
/// final states are left out.
bool SameOutcome(const RolloutResult& a, const RolloutResult& b);

}  // namespace hires::imagination
