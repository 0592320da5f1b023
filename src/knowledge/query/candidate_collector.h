#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "knowledge/query/query_conditions.h"
#include "knowledge/query/query_cursor.h"

namespace hires::knowledge {

/// Up to so many candidates are sorted in memory (some 3 MB); more are walked through by name.
constexpr std::size_t kMaxCandidates = 20'000;

/// Gathers what an access path leads to. Both its cost and its memory are bounded: all functions
/// that return bool return false where the path is not to be followed further.
class CandidateCollector {
 public:
  /// @param after  What stands there or before it was told on earlier pages.
  CandidateCollector(const QueryConditions& conditions, std::optional<QueryPosition> after,
                     Instances* instances);

  /// Forgets what was gathered. @param allowance  Work that the path may cost.
  void Begin(std::int64_t allowance);
  /// On one row.
  bool Spend(int work) {
    ++visited_;
    allowance_ -= work;
    return allowance_ >= 0;
  }
  bool Add(const IndexEntry& entry);
  bool AddRows(Rows* rows, int work);  ///< all of them, each of that much work
  /// There is too much on the path, whatever it may cost.
  bool GiveUp();

  bool gave_up() const { return gave_up_; }           ///< since `Begin`
  std::uint64_t visited() const { return visited_; }  ///< rows since construction
  std::vector<QueryPosition> Take();                  ///< in order, each validity once

 private:
  const QueryConditions& conditions_;
  std::optional<QueryPosition> after_;
  Instances* instances_;
  std::int64_t allowance_{0};
  bool gave_up_{false};
  std::uint64_t visited_{0};
  std::vector<QueryPosition> candidates_;
};

}  // namespace hires::knowledge
