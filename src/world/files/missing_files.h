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

/// Why model://name/... was found in none of the folders: the model is there and the file is not,
/// with the one that comes nearest, or there is no such model, with models that come near. Opens
/// with `where`.
std::string WhyNoModel(const std::string& uri, const std::vector<std::string>& folders,
                       const std::string& where);

}  // namespace hires::world
