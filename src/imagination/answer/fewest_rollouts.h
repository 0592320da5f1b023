#pragma once

#include <algorithm>
#include <optional>

namespace hires::imagination {

/// The smallest number beyond `from` and up to `most` that suffices, where all larger ones do.
template <typename Suffices>
std::optional<int> FewestRollouts(int from, int most, const Suffices& suffices) {
  int too_few = from;
  int enough = from;
  do {
    if (enough >= most) return std::nullopt;
    too_few = enough;
    enough = std::min(2 * enough, most);
  } while (!suffices(enough));
  while (enough - too_few > 1) {
    const int middle = too_few + (enough - too_few) / 2;
    (suffices(middle) ? enough : too_few) = middle;
  }
  return enough;
}

}  // namespace hires::imagination
