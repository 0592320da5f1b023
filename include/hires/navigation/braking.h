#pragma once

#include <array>
#include <string>
#include <vector>

#include "hires/base/param_reader.h"
#include "hires/geometry/pose.h"
#include "hires/robot/robot_profile.h"

// How a base stops so that what stands on it goes on standing. docs/notes_braking.md derives the
// formulas and compares them with the simulator.
namespace hires::navigation {

/// How hard and how suddenly a base may brake. Both > 0.
struct BrakingLimits {
  double max_deceleration{1.0};  ///< [m/s^2]
  double max_jerk{2.5};          ///< [m/s^3]
};

/// The shortest stop along a line with limited deceleration and jerk: the deceleration rises,
/// stays, and falls back to 0 as the speed does. Closed form: no integration, any time at once.
class StopProfile {
 public:
  /// @param speed  [m/s] at the beginning, >= 0.
  /// @param acceleration  [m/s^2] at the beginning. A positive one lets the speed rise at first; a
  /// deceleration above the limit is eased off to it; one too strong to be eased off before the
  /// base would roll back, a > sqrt(2 j v), counts as just that much.
  /// @pre speed >= 0, both limits > 0
  StopProfile(double speed, double acceleration, const BrakingLimits& limits);

  double duration() const { return duration_; }  ///< [s]
  double distance() const { return distance_; }  ///< [m]
  /// @param time  [s] since the beginning; beyond the end the base stands.
  double SpeedAt(double time) const;
  double AccelerationAt(double time) const;  ///< negative while braking
  double DistanceAt(double time) const;

 private:
  struct Phase {
    double duration{0.0}, jerk{0.0};
    double begin{0.0}, distance{0.0}, speed{0.0}, acceleration{0.0};  // when it begins
  };
  struct Moment;
  static Moment During(const Phase& phase, double time);
  Moment At(double time) const;

  std::array<Phase, 3> phases_;
  double duration_{0.0}, distance_{0.0};
};

/// Distance of a stop from steady speed [m]: v/2 (v/a + a/j), or v sqrt(v/j) where the deceleration
/// never reaches its limit (v < a^2/j).
double StoppingDistance(double speed, const BrakingLimits& limits);
double StoppingTime(double speed, const BrakingLimits& limits);  ///< [s] likewise

/// What decides whether a thing that stands on its own keeps its feet.
struct StandingLoad {
  std::string name;
  double support{0.0};     ///< [m] from below its centre of mass to the nearest edge of its base
  double com_height{0.0};  ///< [m] of its centre of mass over its base
  double friction{1.0};    ///< Coulomb coefficient of its base, as the model says
};

/// Horizontal acceleration of what it stands on from which it tips: g support / height [m/s^2].
double TippingAcceleration(const StandingLoad& load, double gravity);
double SlidingAcceleration(const StandingLoad& load, double gravity);  ///< mu g [m/s^2]

/// How far things and base may be from what the catalogue and the profile say.
struct BrakingMargins {
  double support_share{0.9};     ///< of the modelled one: chamfered feet
  double com_height_share{1.1};  ///< of the modelled one: fillings
  double com_offset{0.003};      ///< [m] off the middle
  double friction_share{0.4};    ///< of the modelled one: smooth wood on smooth plastic
  double sway_share{1.3};        ///< of the profile's compliance: soft tyres
  double damping_share{0.8};     ///< of the profile's damping of the wheels' loop
  double rise_periods{1.0};      ///< periods of the sway in which the deceleration rises
  double used_share{0.9};        ///< of what is then left: floor, noise
};

/// How stops are planned: section `braking` of config/base_guard.yaml.
struct BrakingParams {
  BrakingLimits unknown_load{1.0, 2.5};  ///< where it is unknown what is carried
  BrakingLimits hardest{1.5, 10.0};      ///< also with nothing on the tray
  double max_angular_deceleration{1.5};  ///< [rad/s^2]
  double max_angular_jerk{6.0};          ///< [rad/s^3]
  double load_reach{0.4};                ///< [m] from the base's centre to the farthest load
  BrakingMargins margins;
};
/// @throws base::ConfigError naming file and key.
BrakingParams ReadBrakingParams(base::ParamReader in);

/// Where loads stand and what moves them.
struct CarryingBase {
  robot::BaseControllerParams controller;
  double tray_height{0.35};  ///< [m] over the floor
  double gravity{9.81};      ///< [m/s^2]
};

/// How hard the base may brake so that the weakest of the loads neither tips nor slides, with the
/// margins, although the wheels overshoot the ramp and the body sways: at most params.hardest, also
/// without loads.
BrakingLimits LimitsFor(const std::vector<StandingLoad>& loads, const CarryingBase& base,
                        const BrakingParams& params);

/// By how much of a step a damped oscillation overshoots when its target rises linearly within
/// `rise_time` [s]: at most exp(-pi d / sqrt(1 - d^2)), what a sudden step gives, and at most
/// 2 / (w T), what an undamped one gives. 0 from critical damping on.
/// @pre frequency > 0 [rad/s], damping >= 0, rise_time >= 0
double OvershootShare(double frequency, double damping, double rise_time);

/// A stop in the plane: the twist shrinks as a whole, so that the base stays on its arc. The load,
/// up to `load_reach` from the base's centre, is braked no harder than the limits, what the arc
/// itself asks of it included.
class PlanarStop {
 public:
  /// @param A_B  derivative of V_B at the beginning [m/s^2, rad/s^2]. What speeds the base up ends
  /// at once; what brakes it goes on, within the limits.
  PlanarStop(const geometry::Twist2& V_B, const geometry::Twist2& A_B, const BrakingLimits& limits,
             const BrakingParams& params);

  geometry::Twist2 VelocityAt(double time) const;  ///< [s] since the beginning
  double duration() const { return scale_.duration(); }
  double distance() const;  ///< [m] of the base's centre, along its arc

 private:
  geometry::Twist2 V_B_;
  StopProfile scale_;  // share of V_B that is left: from 1 to 0
};

}  // namespace hires::navigation
