#pragma once

#include <cstdint>

namespace hires::planning {

/// One hash of two: a multiplicative step and a fold, as in splitmix64 [Steele et al. 2014]. For
/// telling situations of one search apart, nothing secret.
inline std::uint64_t Mix(std::uint64_t a, std::uint64_t b) {
  std::uint64_t x = a * 0x9e3779b97f4a7c15ULL + b;
  x ^= x >> 32;
  x *= 0xd6e8feb86659fd93ULL;
  return x ^ (x >> 32);
}

}  // namespace hires::planning
