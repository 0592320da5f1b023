#pragma once

#include <algorithm>
#include <deque>
#include <utility>

namespace hires::sensing {

/// Values with their stamps [s], oldest first; the order in which they come does not matter.
template <typename T>
class History {
 public:
  struct Entry {
    double stamp;
    T value;
  };

  /// Nothing happens if there is one of that stamp already. @return whether it was new.
  bool Insert(double stamp, T value) {
    const auto place = UpperBound(stamp);
    if (place != entries_.begin() && std::prev(place)->stamp == stamp) return false;
    entries_.insert(place, {stamp, std::move(value)});
    return true;
  }
  /// Keeps what lies between the two, ends included.
  void KeepBetween(double from, double to) {
    while (!entries_.empty() && entries_.front().stamp < from) entries_.pop_front();
    while (!entries_.empty() && entries_.back().stamp > to) entries_.pop_back();
  }
  void Clear() { entries_.clear(); }

  bool empty() const { return entries_.empty(); }
  const Entry& front() const { return entries_.front(); }
  const Entry& back() const { return entries_.back(); }
  auto begin() const { return entries_.begin(); }
  auto end() const { return entries_.end(); }

  /// The newest that is not newer than `time`, or nullptr.
  const Entry* Before(double time) const {
    const auto place = UpperBound(time);
    return place == entries_.begin() ? nullptr : &*std::prev(place);
  }
  /// The oldest that is newer than `time`, or nullptr.
  const Entry* After(double time) const {
    const auto place = UpperBound(time);
    return place == entries_.end() ? nullptr : &*place;
  }
  T* Find(double stamp) {
    const auto place =
        std::lower_bound(entries_.begin(), entries_.end(), stamp,
                         [](const Entry& entry, double s) { return entry.stamp < s; });
    return place == entries_.end() || place->stamp != stamp ? nullptr : &place->value;
  }

 private:
  auto UpperBound(double time) const {
    return std::upper_bound(entries_.begin(), entries_.end(), time,
                            [](double t, const Entry& entry) { return t < entry.stamp; });
  }

  std::deque<Entry> entries_;
};

}  // namespace hires::sensing
