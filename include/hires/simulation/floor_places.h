#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

namespace hires::simulation {

/// A strip across the floor that wheels roll over: a door sill, a cable cover.
struct Sill {
  Eigen::Vector2d from_M{0.0, 0.0}, to_M{0.0, 0.0};  ///< [m] ends of its middle line
  double width{0.0};                                 ///< [m] of its top
  double height{0.0};                                ///< [m]
};

/// A round place where wheels find little grip.
struct SlipperyPatch {
  Eigen::Vector2d center_M{0.0, 0.0};  ///< [m]
  double radius{0.0};                  ///< [m]
  double traction{0.0};                ///< [m/s^2] the most that the base speeds up or brakes there
};

/// Places of a floor that are not like the rest of it. A world as it was measured has none.
struct FloorPlaces {
  std::vector<Sill> sills;
  std::vector<SlipperyPatch> patches;

  /// [m] to which a wheel is lifted at a point: the height over the top, a smooth ramp of 0.05 m
  /// beside it, as long as a wheel of 0.075 m radius takes to climb 5 mm on its tyre.
  double HeightAt(const Eigen::Vector2d& p_M) const;
  /// [m/s^2] of the most slippery patch around the point; infinite outside of all.
  double TractionAt(const Eigen::Vector2d& p_M) const;
};

inline constexpr double kFullTraction = std::numeric_limits<double>::infinity();

}  // namespace hires::simulation
