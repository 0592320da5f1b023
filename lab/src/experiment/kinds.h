#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lab/src/experiment/chain.h"
#include "lab/src/experiment/stage.h"
#include "hires/base/action.h"
#include "base/parallel.h"
#include "hires/base/rng.h"
#include "lab/src/experiment/experiment.h"
#include "hires/imagination/rollout_result.h"

// The kinds of experiments: each has a function that plays and one that sums up what was played.
// Summing up nothing gives the names of the measures.
namespace hires::lab {

using Chains = std::vector<std::vector<Leg>>;
using Rollouts = std::vector<imagination::RolloutResult>;

/// Goals in rounds: each once a round, shuffled, never one directly after itself; the robot stands
/// at goals.front() before the first.  @pre at least two goals.
std::vector<std::string> ShuffledGoals(const std::vector<Goal>& goals, int num_legs, base::Rng rng);

/// @return nothing when cancelled, here and below.
std::optional<Chains> PlayLegs(const LegsConfig& legs, const ExperimentConfig& config,
                               const std::shared_ptr<const Stage>& stage, const base::Crew& crew);
Findings SumUpLegs(const ExperimentConfig& config, const Stage& stage, const Chains& chains);

/// Per motion set, equally many; rollouts of one index make a pair.
std::optional<std::vector<Rollouts>> PlayPaired(const PairedConfig& paired,
                                                const ExperimentConfig& config, const Stage& stage,
                                                const base::Crew& crew);
Findings SumUpPaired(const PairedConfig& paired, const std::vector<Rollouts>& rollouts);

/// Per motion set, in order.
std::optional<std::vector<Chains>> PlayToppleLoop(const ToppleLoopConfig& loop,
                                                  const ExperimentConfig& config,
                                                  const std::shared_ptr<const Stage>& stage,
                                                  const base::Crew& crew,
                                                  const OnExperience& on_experience);
/// @param seed  the experiment's; of the resamples behind the intervals.
Findings SumUpToppleLoop(const ToppleLoopConfig& loop, std::uint64_t seed,
                         const std::vector<Chains>& by_set);

/// By planner of the configuration, then by row, both in order. Torso and arms are played with the
/// first planner only.
using DurationPlays = std::vector<std::vector<Rollouts>>;
DurationPlays NothingPlayed(const DurationsConfig& durations);
/// What a row does; where it starts is the goal of StartOf.
base::ActionCall ActionOf(const DurationsConfig::Row& row);
std::string StartOf(const DurationsConfig& durations, const DurationsConfig::Row& row);
std::optional<DurationPlays> PlayDurations(const DurationsConfig& durations,
                                           const ExperimentConfig& config, const Stage& stage,
                                           const base::Crew& crew);
Findings SumUpDurations(const DurationsConfig& durations, const DurationPlays& plays);

}  // namespace hires::lab
