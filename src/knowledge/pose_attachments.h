#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "hires/knowledge/fluent_yaml.h"

namespace hires::knowledge {

/// Which poses move with which others.
class PoseAttachments {
 public:
  /// @pre no two modifications of one instance
  explicit PoseAttachments(const std::vector<PoseModification>& modifications);

  /// Instances of a circle, the first again at the end; empty if there is none.
  std::vector<std::string> Circle() const;

  /// `instance` and all that moves with it, each once.
  std::vector<std::string> MovedWith(const std::string& instance) const;

  /// Index of the modification of `instance`.  @pre there is one
  std::size_t IndexOf(const std::string& instance) const { return index_.at(instance); }

 private:
  void Add(const PoseModification& modification, std::size_t index);
  std::map<std::string, std::size_t> InOrBeforeCircles() const;
  std::vector<std::string> WithoutAttachments() const;

  std::map<std::string, std::vector<std::string>> attached_;  // each once, by what carries them
  std::map<std::string, std::vector<std::string>> carriers_;  // by what is attached
  std::map<std::string, std::size_t> index_;                  // of modifications, by instance
};

}  // namespace hires::knowledge
