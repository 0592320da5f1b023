#include "simulation/floor/floor_profile.h"

#include <cmath>

#include "hires/geometry/angles.h"

namespace hires::simulation {
namespace {
constexpr double kShortestWave = 0.15;  // [m]; a wheel of 0.075 m radius rolls over shorter ones
constexpr double kLongestWave = 2.4;    // [m]
}  // namespace

FloorProfile::FloorProfile(double roughness, base::Rng rng) : is_flat_(roughness == 0.0) {
  if (is_flat_) return;
  double variance = 0.0;
  for (int i = 0; i < kNumWaves; ++i) {
    const double length =
        kShortestWave * std::pow(kLongestWave / kShortestWave, i / (kNumWaves - 1.0));
    const double direction = rng.Uniform(0.0, 2.0 * geometry::kPi);
    waves_[i].k =
        2.0 * geometry::kPi / length * Eigen::Vector2d(std::cos(direction), std::sin(direction));
    waves_[i].phase = rng.Uniform(0.0, 2.0 * geometry::kPi);
    waves_[i].amplitude = length;
    variance += 0.5 * length * length;
  }
  for (Wave& wave : waves_) wave.amplitude *= roughness / std::sqrt(variance);
}

double FloorProfile::HeightAt(const Eigen::Vector2d& p_M) const {
  if (is_flat_) return 0.0;
  double height = 0.0;
  for (const Wave& wave : waves_) height += wave.amplitude * std::cos(wave.k.dot(p_M) + wave.phase);
  return height;
}

}  // namespace hires::simulation
