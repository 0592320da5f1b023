#pragma once

#include <cstdint>

#include "hires/base/rng.h"

namespace hires::lab {

/// The seed of a stream as one that can be written down everywhere: ROS parameters have 32 bits and
/// a sign.
inline std::uint64_t SeedOf(const base::Rng& rng) {
  constexpr std::uint64_t kLargestSeed = 0x7fffffff;
  return rng.seed() & kLargestSeed;
}

}  // namespace hires::lab
