#include "planning/search/explored.h"

#include <cmath>
#include <utility>

namespace hires::planning {
namespace {

constexpr std::size_t kFirstSize = 1024;      // a power of two, like all sizes
constexpr std::size_t kLastSize = 8'388'608;  // 200 MB; the first half of that is remembered

}  // namespace

Explored::Explored(const PlanRequest& request, SearchPath* path, const SearchLimits* limits)
    : is_wanted_(request.loop_check && request.which != Which::kAll),
      has_costs_(request.which == Which::kBest || std::isfinite(request.max_cost)),
      path_(*path),
      limits_(*limits) {}

bool Explored::IsFutile() {
  if (!is_wanted_ || !path_.has_situation()) return false;
  if (2 * num_used_ >= entries_.size() && entries_.size() < kLastSize) Grow();
  const std::uint64_t situation = path_.situation();
  const std::uint64_t key = situation == 0 ? 1 : situation;
  Entry* entry = Find(key);
  if (entry->key == 0) {
    if (2 * num_used_ >= entries_.size()) return false;
    *entry = {key, path_.cost(), path_.depth()};
    ++num_used_;
    return false;
  }
  const bool is_cheaper = has_costs_ && path_.cost() < entry->cost;
  const bool is_shorter = limits_.was_too_deep() && path_.depth() < entry->depth;
  if (!is_cheaper && !is_shorter) return true;
  *entry = {key, path_.cost(), path_.depth()};
  return false;
}

Explored::Entry* Explored::Find(std::uint64_t key) {
  const std::size_t mask = entries_.size() - 1;
  std::size_t at = (key ^ (key >> 32)) & mask;
  while (entries_[at].key != 0 && entries_[at].key != key) at = (at + 1) & mask;
  return &entries_[at];
}

void Explored::Grow() {
  std::vector<Entry> old(entries_.empty() ? kFirstSize : 2 * entries_.size());
  old.swap(entries_);
  for (const Entry& entry : old) {
    if (entry.key != 0) *Find(entry.key) = entry;
  }
}

}  // namespace hires::planning
