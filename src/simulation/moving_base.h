#pragma once

#include "hires/base/rng.h"
#include "hires/robot/robot_profile.h"
#include "hires/simulation/base_drive.h"
#include "hires/simulation/disturbances.h"
#include "hires/simulation/floor_places.h"
#include "hires/simulation/variation.h"
#include "simulation/floor/floor_profile.h"

namespace hires::simulation {

/// A base that drives on its floor: wheels that slip, a body that leans, a floor that is uneven.
class MovingBase {
 public:
  struct State {
    BaseDrive drive;
    base::Rng slip_rng;
    double slip{0.0};
    geometry::Pose3 X_MB;  ///< leaning and floor included
    Disturbances disturbances;
  };

  /// @param places  of the floor; they outlive this.
  /// @param start  where the base is really put.
  /// @param rng  of the simulator; its forks 0 and 1 are used.
  MovingBase(const robot::RobotProfile& profile, const FloorPlaces& places,
             const Variation& variation, const geometry::Pose2& start, double time_step,
             const base::Rng& rng);

  /// As BaseDrive::Send.
  void Send(const geometry::Twist2& velocity, double time) { state_.drive.Send(velocity, time); }
  /// As BaseDrive::Push.
  void Push(const std::optional<geometry::Twist2>& acceleration) {
    state_.drive.Push(acceleration);
  }
  /// Draws how the wheels slip from now on. @param dt  [s] since they were drawn last.
  void DrawSlip(double dt);
  void Step(double time, double next_time);

  const BaseMotion& motion() const { return state_.drive.motion(); }
  const geometry::Pose3& X_MB() const { return state_.X_MB; }
  const Disturbances& disturbances() const { return state_.disturbances; }
  /// Of a thing at `p_M` that moves along with the base, in map axes; leaning apart.
  geometry::Twist3 VelocityAt(const Eigen::Vector3d& p_M) const;

  const State& Save() const { return state_; }
  void Restore(const State& state) { state_ = state; }

 private:
  geometry::Pose3 LeaningPose() const;
  double HeightAt(const Eigen::Vector2d& p_M) const;

  double wheel_slip_;
  double time_step_;  // [s]
  robot::MotionSet limits_;
  double wheel_arm_;  // [m] of the wheels from the base's origin, along x and along y
  FloorProfile floor_;
  const FloorPlaces& places_;
  State state_;
};

}  // namespace hires::simulation
