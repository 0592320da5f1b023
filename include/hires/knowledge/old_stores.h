#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace hires::knowledge {

/// How much of the stores of earlier runs is kept.
struct OldStoreLimits {
  double max_age{0.0};         ///< [days] since the last change; 0: any
  std::uint64_t max_bytes{0};  ///< of all together, the new one apart; 0: any
};

/// Removes stores of earlier runs beside the store of this one: `X_run_....db`, as launch files
/// call them, with their logs; those that are too old, then the oldest until the rest is small
/// enough. Files that are no Blackboard store, this run's own store, and stores that another
/// process writes are left alone; where `store` is not such a name, nothing is removed.
/// @param now  moment that ages are counted to.
/// @return the files that are gone, without their logs.
std::vector<std::string> PruneOldStores(const std::string& store, const OldStoreLimits& limits,
                                        std::filesystem::file_time_type now);

}  // namespace hires::knowledge
