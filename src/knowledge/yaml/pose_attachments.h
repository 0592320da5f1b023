#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "hires/knowledge/fluent_yaml.h"

namespace hires::knowledge {

/// Orders instances by name, as the store does: the case of ASCII letters does not count.
struct LessIgnoringCase {
  bool operator()(const std::string& a, const std::string& b) const;
};

template <typename Value>
using ByInstance = std::map<std::string, Value, LessIgnoringCase>;

/// `where` names the modification.  @throws ConfigError, always.
[[noreturn]] void FailModification(const std::string& where, const std::string& what);

/// Which poses move with which others. Names are told as they were spelled first.
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
  ByInstance<std::size_t> InOrBeforeCircles() const;
  std::vector<std::string> WithoutAttachments() const;

  ByInstance<std::vector<std::string>> attached_;  // each once, by what carries them
  ByInstance<std::vector<std::string>> carriers_;  // by what is attached
  ByInstance<std::size_t> index_;                  // of modifications, by instance
};

}  // namespace hires::knowledge
