#pragma once

#include <map>
#include <string>
#include <vector>

namespace hires::world {

/// Files that worlds and objects name and that are not there, gathered so that all are told at
/// once.
class MissingFiles {
 public:
  /// @param place  "hall.world:12".  @param error  what the finder said of it, this place before
  /// it.
  void Add(const std::string& place, const std::string& error);

  /// @throws base::ConfigError with all, each with its place, what is named several times once.
  void ThrowIfAny(const std::string& path) const;

 private:
  std::vector<std::string> texts_;                          // in the order of discovery
  std::map<std::string, std::vector<std::string>> places_;  // of each text
};

}  // namespace hires::world
