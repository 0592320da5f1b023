#pragma once

#include <algorithm>
#include <cmath>

// Closed forms and an integrator of hazards that contact physics does not play: a robot that tips
// over, liquids that slosh, wheels that meet a step. SI units.
namespace hires::physics {

/// A rigid body that can rotate about one straight edge of its support, seen along that edge.
struct EdgeRocker {
  double support{0.0};     ///< b [m] horizontally from the edge to the center of mass; > 0: inside
  double com_height{0.0};  ///< c [m] of the center of mass above the edge, > 0
  double inertia{0.0};     ///< I_A / m [m^2] about the edge, >= b^2 + c^2
  double tilt{0.0};        ///< [rad] >= 0
  double rate{0.0};        ///< [rad/s]

  /// [m/s^2] of the floor towards the body's inside, from which it lifts off: g b / c.
  double TippingAcceleration(double gravity) const { return gravity * support / com_height; }
  /// Its center of mass is beyond the edge.
  bool is_over() const { return tilt >= std::atan2(support, com_height); }
  /// Rocking without slip while the floor accelerates by a towards the inside, by semi-implicit
  /// Euler: theta'' = (a (c cos theta + b sin theta) - g (b cos theta - c sin theta)) / (I_A / m)
  /// [Housner 1963, Bull. Seism. Soc. Am. 53:403-417]. It comes back without a rebound.
  void Step(double acceleration, double gravity, double dt) {
    if (tilt <= 0.0 && acceleration * com_height <= gravity * support) return;
    const double up = com_height * std::cos(tilt) + support * std::sin(tilt);
    const double in = support * std::cos(tilt) - com_height * std::sin(tilt);
    rate += dt * (acceleration * up - gravity * in) / inertia;
    tilt += dt * rate;
    if (tilt <= 0.0) tilt = rate = 0.0;
  }
};

/// [rad/s] First sloshing mode of a liquid of that depth h in an upright cylinder of radius R [m]:
/// omega^2 = (1.841 g / R) tanh(1.841 h / R) [Ibrahim 2005, Liquid Sloshing Dynamics, ch. 1].
inline double SloshFrequency(double radius, double depth, double gravity) {
  constexpr double kFirstMode = 1.8412;  // first zero of J1'
  return std::sqrt(kFirstMode * gravity / radius * std::tanh(kFirstMode * depth / radius));
}

/// [m] By which the surface is higher at the wall under a constant horizontal acceleration a, as it
/// is normal to the apparent gravity: a R / g. After a sudden start it comes to twice that: each
/// undamped mode (z'' + omega^2 z = omega^2 z_static, from rest) gives z_static (1 - cos omega t).
inline double SurfaceRise(double acceleration, double radius, double gravity) {
  return acceleration * radius / gravity;
}
inline constexpr double kSuddenSlosh = 2.0;  ///< times SurfaceRise

/// [m/s] By which a rigid wheel that rolls at `speed` v is slower at once when it meets a step:
/// v (1 - cos^2 phi), cos phi = 1 - h / r (the inelastic impact keeps v cos phi across the line to
/// the corner, and cos phi of that horizontally); all of it where h >= r.
inline double SpeedLossAtStep(double speed, double height, double wheel_radius) {
  const double cosine = std::clamp(1.0 - height / wheel_radius, 0.0, 1.0);
  return speed * (1.0 - cosine * cosine);
}

}  // namespace hires::physics
