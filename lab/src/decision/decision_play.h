#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lab/src/decision/decision.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/imagination/scheduler.h"

// What a task of `hires_lab experiment decision` is made of: imagined once for all truths, played once
// with each motion set, and many times per load, route and height for the oracle.
namespace hires::lab {

/// Plays one drive in the truth.  @return nothing when cancelled.
using PlayTruth = std::function<std::optional<TruthPlay>(
    const DecisionTask& task, const std::string& motion_set, std::uint64_t seed)>;

/// What tasks are imagined and played with.
struct DecisionParts {
  const imagination::ImaginationSetup& setup;
  imagination::SchedulerParams scheduler;  ///< with prices
  int oracle_plays{0};
  PlayTruth play{};
  std::function<bool()> cancelled{};
};

/// Of all that imagination is handed: files by their hashes, start, alternatives, seed, prices, how
/// it decides. No truth is among it. Tasks with the same hash have the same answer.
/// @throws base::ConfigError for names that the setup does not know.
std::uint64_t RequestHash(const DecisionTask& task, const DecisionParts& parts);

/// What the arms that imagine are told; rollouts are played once however many arms and prices ask.
/// @return nothing when cancelled.  @throws base::ConfigError for a task that makes no sense.
std::optional<ImaginedTask> Imagine(const DecisionTask& task, const DecisionParts& parts);

/// Each motion set under the task's own seed.  @return nothing when cancelled.
std::optional<std::map<std::string, TruthPlay>> PlayAlternatives(const DecisionTask& task,
                                                                 const DecisionParts& parts);

/// The oracle's plays of one motion set, the same for all tasks of one cell.
/// @return nothing when cancelled.
std::optional<std::vector<TruthPlay>> PlayForOracle(const DecisionTask& task,
                                                    const std::string& motion_set,
                                                    const DecisionParts& parts);

}  // namespace hires::lab
