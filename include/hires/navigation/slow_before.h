#pragma once

#include <Eigen/Core>
#include <vector>

#include "hires/geometry/polygon.h"
#include "hires/geometry/pose.h"

namespace hires::navigation {

/// How a base comes to rest before what it sees.
struct SlowBeforeParams {
  double gap{0.01};                  ///< [m] that stays between footprint and thing
  double deceleration{0.5};          ///< [m/s^2]
  double angular_deceleration{0.5};  ///< [rad/s^2]
  double reaction_time{0.15};        ///< [s] from what is seen to what the wheels do of it
};

/// A velocity [in the base], or as much less of it, in every component alike, that the base can
/// still stop `gap` before the things that it sees on the arc it drives. What is nearer already
/// stops only what would bring it nearer. So nothing is ever driven faster, or elsewhere, than
/// wanted. What could never brake does not drive.
/// @param things_B   [m] points in the base.
/// @param footprint  of the base, convex.  @pre no parameter is negative
geometry::Twist2 SlowedBefore(const geometry::Twist2& wanted,
                              const std::vector<Eigen::Vector2d>& things_B,
                              const geometry::Polygon& footprint, const SlowBeforeParams& params);

}  // namespace hires::navigation
