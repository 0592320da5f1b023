#pragma once

#include <array>
#include <deque>
#include <limits>
#include <optional>

#include "hires/geometry/pose.h"
#include "hires/robot/robot_profile.h"
#include "hires/simulation/caster_drive.h"

namespace hires::simulation {

/// How the base moves now.
struct BaseMotion {
  geometry::Pose2 X_MB;
  geometry::Twist2 V_B;   ///< in the base frame
  geometry::Twist2 A_B;   ///< derivative of V_B: [m/s^2], [rad/s^2]
  double pitch{0.0};      ///< [rad] leaning of the base: nose down is positive
  double roll{0.0};       ///< [rad] right side down is positive
  bool timed_out{false};  ///< braking because no command came in time
};

/// A robot's base between the velocity commands it is sent and the motion it makes: lag, what its
/// wheels cannot do (a differential drive ignores sideways commands, as its own does; a car-like
/// one turns by |v| / min_turning_radius at most, at every moment), clipping to the controller's
/// limits, a ramp of limited acceleration (all axes scaled alike, so that the direction of a change
/// is kept) and jerk, casters or a velocity loop of second order, braking on command timeout, with
/// the ramp or at once, and the leaning of the body on its wheels. A value: copy it to save it.
class BaseDrive {
 public:
  BaseDrive(const robot::BaseControllerParams& params, const geometry::Pose2& X_MB);

  /// A command sent at `time` [s]; it takes effect after the command lag.
  /// @pre times do not decrease.
  void Send(const geometry::Twist2& velocity, double time);

  /// Something pushes the base: what it adds to the derivative of V_B [m/s^2], [rad/s^2] until
  /// another push is told, or that there is none any more. The wheels' loop works against it.
  void Push(const std::optional<geometry::Twist2>& acceleration) { push_ = acceleration; }

  /// Moves on from `time` to `time + dt`. `slip` is the share of the wanted velocity that the
  /// wheels lose: 0 is perfect grip. It acts through the velocity loop, which cannot jump.
  /// `traction` [m/s^2] is the most that the wheels speed the base up or brake it; a wheel at
  /// kTurningArm from the middle has no more for turning.
  void Step(double time, double dt, double slip,
            double traction = std::numeric_limits<double>::infinity());

  static constexpr double kTurningArm = 0.32;  ///< [m] of the PR2's casters

  const BaseMotion& motion() const { return motion_; }

 private:
  struct Axis {
    double ramp{0.0};          // velocity that the ramp asks for
    double ramp_rate{0.0};     // its derivative
    double velocity{0.0};      // of the velocity loop
    double acceleration{0.0};  // its derivative
  };
  using Axes = std::array<Axis, 3>;  // x, y, yaw
  struct Lean {
    double angle{0.0};
    double rate{0.0};
  };
  struct Sent {
    double effective{0.0};  // [s]
    geometry::Twist2 velocity;
  };
  void Receive(double time);
  void StandAtOnce();
  void StepRamp(const geometry::Twist2& target, bool is_late, double dt);
  void StepAxis(Axis* axis, double grip, double dt) const;
  void StepCasters(double grip, double traction, double dt);
  void KeepToArc(const Axis& yaw_before, double dt);
  void SlideAxes(const Axes& before, double traction, double dt);
  void AddPush(double dt);
  geometry::Twist2 Acceleration() const;
  double StepLean(Lean* lean, double acceleration, double dt) const;

  robot::BaseControllerParams params_;
  std::deque<Sent> sent_;
  geometry::Twist2 target_;
  double last_command_{-1e9};  // [s] when the command in force took effect
  Axis x_, y_, yaw_;
  std::optional<CasterDrive> casters_;  // in the place of the velocity loop
  Lean pitch_, roll_;
  std::optional<geometry::Twist2> push_;
  BaseMotion motion_;
};

}  // namespace hires::simulation
