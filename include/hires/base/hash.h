#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace hires::base {

/// Incremental FNV-1a of 64 bits: tells apart worlds, robots and configurations, nothing secret.
class Hasher {
 public:
  void Add(std::string_view bytes);  ///< length first, so that "ab","c" differs from "a","bc"
  void Add(double value);            ///< by bit pattern; -0.0 counts as 0.0
  void Add(std::uint64_t value);
  std::uint64_t value() const { return value_; }

 private:
  void AddByte(unsigned char byte);
  std::uint64_t value_{14695981039346656037ULL};
};

std::string HexOf(std::uint64_t hash);  ///< 16 lower-case digits

}  // namespace hires::base
