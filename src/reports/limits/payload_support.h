#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hires/imagination/imagination_setup.h"

namespace hires::reports {

/// A payload at its start pose on the tray, seen from above along the axes of the base frame B.
struct PayloadSupport {
  std::string name;
  Eigen::Vector2d p_BCom{0.0, 0.0};  ///< [m] center of mass
  Eigen::Vector2d p_BO{0.0, 0.0};    ///< [m] its origin
  /// [m] Convex support polygon, origin below the center of mass: hull of the part of its contact
  /// area that the plate carries.
  geometry::Polygon support;
  double com_height{0.0};  ///< [m] of the center of mass over the contact area
  double friction{1.0};    ///< Coulomb coefficient: the smaller one of payload and plate
  /// [m^2] I / m about the horizontal axes through the center of mass.
  Eigen::Matrix2d gyration{Eigen::Matrix2d::Zero()};
  bool rolls{false};                   ///< it touches the plate with one round shape only
  Eigen::Vector2d overhang{0.0, 0.0};  ///< [m] beyond the plate's edges along x and y; >= 0

  /// [m/s^2] Acceleration of the base along `direction` (or against it: the payload tips this way)
  /// from which it tips: g b / c, b from the center of mass to the edge of the support polygon.
  /// @param direction  unit vector in B in which the force of inertia points.
  double TippingAcceleration(const Eigen::Vector2d& direction, double gravity) const;
  /// [m/s] from which a sudden stop of motion along `direction` overturns it about an edge, without
  /// slip: physics::SuddenStopTopplingSpeed of the velocity across that edge.
  double TopplingSpeed(const Eigen::Vector2d& direction, double gravity) const;
  /// mu g [m/s^2].
  double SlidingAcceleration(double gravity) const { return friction * gravity; }
  /// Unit normals of the support polygon's edges, outward.
  std::vector<Eigen::Vector2d> Normals() const;
};

/// Payloads as imagination::StartOnTray puts them together on the tray.
/// @throws base::ConfigError with all errors: as StartOnTray and navigation::LoadOf, payloads that
/// overlap, and payloads whose lowest points have no plate below them.
std::vector<PayloadSupport> SupportsOnTray(const imagination::ImaginationSetup& setup,
                                           const std::vector<std::string>& objects);

}  // namespace hires::reports
