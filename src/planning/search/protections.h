#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "hires/planning/term.h"

namespace hires::planning {

/// Atoms that must go on to hold, each with the number of protections it has.
class Protections {
 public:
  explicit Protections(TermTable* terms) : terms_(*terms) {}

  void Add(Term atom) { Set(atom, Count(atom) + 1); }
  void Remove(Term atom) {  ///< no effect where there is none
    if (const int count = Count(atom)) Set(atom, count - 1);
  }
  int Count(Term atom) const {
    const auto found = counts_.find(atom.bits());
    return found == counts_.end() ? 0 : found->second.count;
  }
  bool empty() const { return counts_.empty(); }
  template <typename Visit>
  bool AllOf(Visit visit) const {
    for (const auto& [bits, entry] : counts_) {
      if (!visit(entry.atom)) return false;
    }
    return true;
  }

  std::size_t Remember() const { return trail_.size(); }
  void Undo(std::size_t mark) {
    while (trail_.size() > mark) {
      const Entry old = trail_.back();
      trail_.pop_back();
      Put(old.atom, old.count);
    }
  }
  std::uint64_t hash() const { return hash_; }

 private:
  struct Entry {
    Term atom;
    int count;
  };
  void Set(Term atom, int count) {
    trail_.push_back({atom, Count(atom)});
    Put(atom, count);
  }
  void Put(Term atom, int count) {
    const std::uint64_t weight = terms_.Hash(atom) | 1;
    hash_ += weight * static_cast<std::uint64_t>(count - Count(atom));
    if (count == 0) {
      counts_.erase(atom.bits());
    } else {
      counts_[atom.bits()] = {atom, count};
    }
  }

  TermTable& terms_;
  std::unordered_map<std::uint32_t, Entry> counts_;
  std::vector<Entry> trail_;
  std::uint64_t hash_{0};
};

}  // namespace hires::planning
