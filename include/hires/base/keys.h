#pragma once

#include <string>
#include <vector>

namespace hires::base {

/// The keys of a map from names, in its order: what a message lists as known.
template <typename Map>
std::vector<std::string> KeysOf(const Map& map) {
  std::vector<std::string> keys;
  keys.reserve(map.size());
  for (const auto& entry : map) keys.push_back(entry.first);
  return keys;
}

}  // namespace hires::base
