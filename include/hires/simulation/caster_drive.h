#pragma once

#include <array>

#include "hires/geometry/pose.h"
#include "hires/robot/caster_params.h"

namespace hires::simulation {

/// A base on steered casters as the published controllers drive it: casters turn to where the
/// commanded twist sends their axes, wheels are given the speed that it has where they stand, along
/// the direction in which they stand now. Wheels roll without slip; sideways a tyre holds by
/// friction. So a base whose casters still turn is pushed sideways, and one whose command ends at
/// once is stopped by what the wheels' motors give. A value: copy it to save it.
class CasterDrive {
 public:
  static constexpr int kNumCasters = 4;

  explicit CasterDrive(const robot::CasterParams& params);

  /// Moves on by `dt` [s].
  /// @param commanded  twist that the controller's ramp has come to, in the base frame.
  /// @param traction  [m/s^2] more than this no floor gives, whatever the tyres are.
  /// @param V_B  the base's twist; becomes that at the end.
  void Step(const geometry::Twist2& commanded, double traction, double dt, geometry::Twist2* V_B);

  /// [rad] of the casters front left, front right, back left, back right, in (-pi, pi].
  std::array<double, kNumCasters> Angles() const;

 private:
  struct Caster {
    double x{0.0}, y{0.0};                // [m] axis in the base frame
    double steering_damping{0.0};         // [N m s] gain of version 2
    double cos{1.0}, sin{0.0};            // of its angle
    double wanted_x{1.0}, wanted_y{0.0};  // along where it is to point, of any length
    double error{0.0};                    // [rad] to there, or to the opposite if that is nearer
    double rate{0.0};                     // [rad/s] against the base
    double filtered_rate{0.0};
    std::array<double, 2> filtered_speeds{};  // [rad/s] of its wheels, left and right
  };
  /// What a caster's wheels do: force along its direction [N], moment about its axis [N m].
  struct Rolling {
    double force{0.0}, moment{0.0};
  };
  /// Inertia against changes of the twist, symmetric, and what acts on it [N], [N], [N m].
  struct Balance {
    double xx{0.0}, xy{0.0}, xw{0.0}, yy{0.0}, yw{0.0}, ww{0.0};
    double force_x{0.0}, force_y{0.0}, moment{0.0};
    geometry::Twist2 Solve(double dt) const;
  };
  void StepOnce(const geometry::Twist2& commanded, double hold, double dt, geometry::Twist2* V_B);
  void Aim(const geometry::Twist2& commanded, Caster* caster) const;
  double SteeringEffort(Caster* caster) const;
  Rolling Roll(const geometry::Twist2& commanded, const geometry::Twist2& V_B,
               Caster* caster) const;
  void AddTo(Balance* balance, const Caster& caster, const geometry::Twist2& V_B, double force,
             double hold, double dt) const;
  bool IsAtRest(const geometry::Twist2& commanded, const geometry::Twist2& V_B) const;
  void ComeToRest(geometry::Twist2* V_B);

  robot::CasterParams params_;
  double wheel_gain_{0.0};     // [N m s]
  double per_radius_{0.0};     // [1/m]
  double wheel_mass_{0.0};     // [kg] that a caster's spinning wheels add along its direction
  double steering_mass_{0.0};  // [kg m^2] against turning a caster, its wheels' rolling included
  std::array<Caster, kNumCasters> casters_;
};

}  // namespace hires::simulation
