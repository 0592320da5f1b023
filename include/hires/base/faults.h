#pragma once

#include <string>
#include <utility>
#include <vector>

#include "hires/base/error.h"

namespace hires::base {

/// What is wrong with the parts of a file, told at once.
class Faults {
 public:
  /// Reads a part; its fault is kept.
  template <typename Read>
  void Collect(const Read& read) {
    try {
      read();
    } catch (const ConfigError& error) {
      texts_.emplace_back(error.what());
    }
  }
  void Add(std::string text) { texts_.push_back(std::move(text)); }

  /// @throws ConfigError with a line for each fault where there is any.
  void Require() const;

 private:
  std::vector<std::string> texts_;
};

}  // namespace hires::base
