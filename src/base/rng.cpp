#include "hires/base/rng.h"

#include <boost/random/bernoulli_distribution.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <boost/random/uniform_real_distribution.hpp>
#include <new>
#include <type_traits>

#include "hires/base/check.h"

namespace hires::base {
namespace {

using Engine = boost::random::mt19937_64;
static_assert(std::is_trivially_copyable_v<Engine>, "an Rng copies its engine byte by byte");
static_assert(std::is_trivially_destructible_v<Engine>, "an Rng does not destroy its engine");

/// SplitMix64 [Steele, Lea, Flood 2014, OOPSLA]: neighbouring inputs give unrelated outputs.
std::uint64_t Mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

Engine& EngineIn(std::byte* storage) { return *std::launder(reinterpret_cast<Engine*>(storage)); }

}  // namespace

Rng::Rng(std::uint64_t seed) : seed_(seed) {
  static_assert(sizeof(engine_) == sizeof(Engine));
  static_assert(alignof(Rng) >= alignof(Engine));
  new (engine_) Engine(Mix(seed));
}

Rng Rng::Fork(std::uint64_t id) const { return Rng(Mix(seed_ ^ Mix(id + 1))); }

double Rng::Uniform(double lower, double upper) {
  HIRES_CHECK(lower <= upper, "an interval ends before it begins");
  if (lower == upper) return lower;
  return boost::random::uniform_real_distribution<double>(lower, upper)(EngineIn(engine_));
}

double Rng::Normal(double mean, double sd) {
  HIRES_CHECK(sd >= 0.0, "a standard deviation is negative");
  if (sd == 0.0) return mean;
  return boost::random::normal_distribution<double>(mean, sd)(EngineIn(engine_));
}

bool Rng::Bernoulli(double probability) {
  HIRES_CHECK(probability >= 0.0 && probability <= 1.0, "a probability lies outside 0 .. 1");
  return boost::random::bernoulli_distribution<double>(probability)(EngineIn(engine_));
}

int Rng::Index(int size) {
  HIRES_CHECK(size >= 1, "there is nothing to choose from");
  return boost::random::uniform_int_distribution<int>(0, size - 1)(EngineIn(engine_));
}

Rng Rng::Split() { return Rng(EngineIn(engine_)()); }

}  // namespace hires::base
