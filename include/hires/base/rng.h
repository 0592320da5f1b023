#pragma once

#include <cstddef>
#include <cstdint>

namespace hires::base {

/// A stream of chance with a seed of its own. The same seed gives the same numbers with every
/// compiler (Boost.Random: the standard library's distributions differ between vendors).
class Rng {
 public:
  explicit Rng(std::uint64_t seed);

  /// A stream for one sub-task; depends on this stream's seed and `id` only, never on how many
  /// numbers were drawn before, so that work can be spread and repeated in any order.
  Rng Fork(std::uint64_t id) const;

  double Uniform(double lower, double upper);  ///< in [lower, upper); lower if both are equal
  double Normal(double mean, double sd);       ///< @pre sd >= 0; sd 0 gives the mean
  bool Bernoulli(double probability);          ///< @pre probability in [0, 1]
  int Index(int size);                         ///< uniform in 0 .. size - 1.  @pre size >= 1

  Rng Split();  ///< a stream of its own, for one draw of this one

  std::uint64_t seed() const { return seed_; }

 private:
  std::uint64_t seed_;
  /// Room for Boost's mt19937_64, which is slow to compile. A copy of its bytes is a copy of it.
  alignas(std::uint64_t) std::byte engine_[313 * sizeof(std::uint64_t)];
};

}  // namespace hires::base
