#pragma once

namespace hires::robot {

/// A base on four steered casters without trail, two driven wheels each, as a PR2's, and the
/// published controller that drives it (pr2_mechanism_controllers, at 1 kHz). The gains are those
/// of the version; all else is the robot's.
struct CasterParams {
  int version{2};                  ///< 1: Pr2BaseController, 2: Pr2BaseController2
  double at{0.2246};               ///< [m] |x| and |y| of the casters' axes in base_link
  double track{0.098};             ///< [m] between the two wheels of a caster
  double wheel_radius{0.074792};   ///< [m]
  double wheel_inertia{0.0152};    ///< [kg m^2] of a wheel and its motor about the axle
  double wheel_effort{7.0};        ///< [N m] the most that a wheel's motor gives
  double wheel_damping{0.25};      ///< [N m s] that a wheel's rolling meets
  double steering_inertia{0.038};  ///< [kg m^2] of a caster, its wheels included, about its axis
  double steering_effort{6.5};     ///< [N m] the most that a caster's motor gives
  double steering_speed{10.0};     ///< [rad/s] beyond which it gives none
  double steering_damping{1.0};    ///< [N m s]
  double mass{268.0};              ///< [kg] of the robot
  double yaw_inertia{20.0};        ///< [kg m^2] of the robot about base_link's z axis
  double grip{0.8};                ///< friction of tyres against being pushed sideways
};

/// [N m s] effort of a wheel's motor for each rad/s that it is too slow.
double WheelGain(const CasterParams& params);

/// [kg] that the wheels speed up along a straight line: the robot, and what their spinning adds.
double RollingMass(const CasterParams& params);

/// [s] by which a steady ramp is trailed while efforts are within their limit: with effort P
/// (wanted
/// - speed) of each wheel, (RollingMass r^2 / 8) / (P + damping).
double RollingLag(const CasterParams& params);

/// Share of a commanded speed that is driven in the end: P / (P + damping).
double RollingShare(const CasterParams& params);

/// [m/s^2] at which all wheels at their limit stop a base that rolls straight on at `speed` [m/s].
double HardestStop(const CasterParams& params, double speed);

}  // namespace hires::robot
