#pragma once

#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/imagination/rollout_result.h"

namespace hires::imagination::test_support {

/// A rollout that reached its goal with everything upright.
/// @param shaking  samples out of 640 (32 s at 20 Hz) in which the object wobbled.
inline RolloutResult Success(double duration = 32.0, int shaking = 0) {
  RolloutResult result;
  result.outcome = Outcome::kSucceeded;
  result.action_finished = true;
  result.duration = duration;
  result.counts = {640 - shaking, shaking, 0};
  result.max_tilt = shaking > 0 ? 0.1 : 0.005;
  return result;
}

/// A rollout that reached its goal, but lost its load on the way.
inline RolloutResult Fall(double duration = 32.0, int topple = 5) {
  RolloutResult result = Success(duration);
  result.outcome = Outcome::kFailed;
  result.failure = base::FailureCode::kObjectFell;
  result.counts = {640 - topple, 0, topple};
  result.falls = 1;
  result.max_tilt = 1.57;
  return result;
}

/// A rollout whose action did not reach its goal.
inline RolloutResult NoPath() {
  RolloutResult result;
  result.outcome = Outcome::kFailed;
  result.failure = base::FailureCode::kNoPath;
  result.counts = {20, 0, 0};
  return result;
}

inline std::vector<RolloutResult> Times(int count, const RolloutResult& result) {
  return std::vector<RolloutResult>(static_cast<std::size_t>(count), result);
}

/// One after the other.
inline std::vector<RolloutResult> operator+(std::vector<RolloutResult> first,
                                            const std::vector<RolloutResult>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

/// How an invented action behaves.
struct Behaviour {
  double fall_probability{0.0};
  double no_path_probability{0.0};
  double mean_duration{30.0};  ///< [s]
  int most_shaking{0};         ///< samples of 640
};

/// Rollout `index` of an action that behaves so; all alternatives share the seed of an index, as
/// common random numbers do.
inline RolloutResult Invent(const Behaviour& behaviour, const base::Rng& seed, int index) {
  base::Rng rng = seed.Fork(static_cast<std::uint64_t>(index));
  const double luck = rng.Uniform(0.0, 1.0);
  const double duration = behaviour.mean_duration + rng.Normal(0.0, 1.0);
  const int shaking = rng.Index(behaviour.most_shaking + 1);
  if (luck < behaviour.fall_probability) return Fall(duration);
  if (luck > 1.0 - behaviour.no_path_probability) return NoPath();
  return Success(duration, shaking);
}

inline std::vector<RolloutResult> InventAll(const Behaviour& behaviour, const base::Rng& seed,
                                            int count) {
  std::vector<RolloutResult> results;
  for (int index = 0; index < count; ++index) results.push_back(Invent(behaviour, seed, index));
  return results;
}

}  // namespace hires::imagination::test_support
