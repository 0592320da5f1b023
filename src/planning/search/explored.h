#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hires/planning/planner.h"
#include "planning/search/search_limits.h"
#include "planning/search/search_path.h"

namespace hires::planning {

/// The situations (facts that hold, tasks left, protections) that a search has been in, on whatever
/// path. What can follow depends on the situation alone, so that it is gone through once: where one
/// plan is wanted, once in all; where cost or depth are bounded, again where the way to it was
/// cheaper or shorter. Where all plans are wanted, each way to a situation gives others. The first
/// four million are remembered.
class Explored {
 public:
  /// @param request, limits  Are referred to.
  Explored(const PlanRequest& request, SearchPath* path, const SearchLimits* limits);

  /// True where the path has led to a situation of which nothing new can come; notes that it was
  /// here.
  bool IsFutile();
  std::size_t bytes() const { return entries_.capacity() * sizeof(Entry); }

 private:
  struct Entry {
    std::uint64_t key{0};  ///< 0: free
    double cost{0.0};
    int depth{0};
  };
  Entry* Find(std::uint64_t key);
  void Grow();

  const bool is_wanted_;
  const bool has_costs_;
  SearchPath& path_;
  const SearchLimits& limits_;
  std::vector<Entry> entries_;  ///< open addressing
  std::size_t num_used_{0};
};

}  // namespace hires::planning
