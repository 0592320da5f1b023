#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace hires::planning {

/// Which situations the current path has been through, by hash, with the way back.
class Visited {
 public:
  Visited() : buckets_(1024, kEnd) {}

  /// False if the path has been there before.
  bool Insert(std::uint64_t key) {
    if (Contains(key)) return false;
    if (entries_.size() >= buckets_.size()) Grow();
    Chain(key);
    return true;
  }
  bool Contains(std::uint64_t key) const {
    std::uint32_t i = buckets_[Bucket(key)];
    while (i != kEnd && entries_[i].key != key) i = entries_[i].next;
    return i != kEnd;
  }
  std::size_t Remember() const { return entries_.size(); }
  void Undo(std::size_t mark) {
    while (entries_.size() > mark) {
      buckets_[Bucket(entries_.back().key)] = entries_.back().next;
      entries_.pop_back();
    }
  }
  std::size_t bytes() const {
    return entries_.capacity() * sizeof(Entry) + buckets_.capacity() * sizeof(std::uint32_t);
  }

 private:
  static constexpr std::uint32_t kEnd = 0xffffffffu;
  struct Entry {
    std::uint64_t key;
    std::uint32_t next;
  };
  std::size_t Bucket(std::uint64_t key) const {
    return (key ^ (key >> 32)) & (buckets_.size() - 1);
  }
  void Chain(std::uint64_t key) {
    std::uint32_t& bucket = buckets_[Bucket(key)];
    entries_.push_back({key, bucket});
    bucket = static_cast<std::uint32_t>(entries_.size() - 1);
  }
  void Grow() {  // oldest first, so that Undo finds the newest at the front of its bucket
    std::vector<Entry> entries;
    entries.swap(entries_);
    buckets_.assign(2 * buckets_.size(), kEnd);
    for (const Entry& entry : entries) Chain(entry.key);
  }

  std::vector<std::uint32_t> buckets_;
  std::vector<Entry> entries_;
};

}  // namespace hires::planning
