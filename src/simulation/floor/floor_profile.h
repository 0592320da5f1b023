#pragma once

#include <Eigen/Core>
#include <array>

#include "hires/base/rng.h"

namespace hires::simulation {

/// The height of an uneven floor: a sum of cosine waves with random directions and phases and
/// wavelengths spread geometrically over 0.15 .. 2.4 m, amplitude proportional to wavelength (the
/// usual spectrum of floors and roads, power ~ wavelength^2 per octave).
class FloorProfile {
 public:
  FloorProfile() = default;  ///< perfectly flat
  /// @param roughness standard deviation of the height [m], >= 0
  FloorProfile(double roughness, base::Rng rng);

  double HeightAt(const Eigen::Vector2d& p_M) const;  ///< [m]
  bool is_flat() const { return is_flat_; }

 private:
  struct Wave {
    Eigen::Vector2d k{0.0, 0.0};  // [rad/m]
    double phase{0.0};
    double amplitude{0.0};  // [m]
  };
  static constexpr int kNumWaves = 12;
  std::array<Wave, kNumWaves> waves_;
  bool is_flat_{true};
};

}  // namespace hires::simulation
