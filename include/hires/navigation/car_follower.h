#pragma once

#include <memory>
#include <vector>

#include "hires/geometry/polygon.h"
#include "hires/navigation/costmap.h"
#include "hires/navigation/dwa.h"
#include "hires/navigation/reeds_shepp.h"
#include "hires/robot/robot_profile.h"

namespace hires::navigation {

/// The speed [m/s] from which a deceleration [m/s^2] that sets in after a reaction time [s] still
/// ends within a distance [m]: distance = v t + v^2 / 2a, solved for v. @pre distance >= 0
double ApproachSpeed(double distance, double deceleration, double reaction_time);

struct CarFollowerParams {
  double control_period{0.1};            ///< [s]
  double xy_goal_tolerance{0.2};         ///< [m]
  double yaw_goal_tolerance{0.17};       ///< [rad]
  double stopped_linear_velocity{0.01};  ///< [m/s]
  double reaction_time{0.15};            ///< [s] from what is seen to what the wheels do of it
  double deceleration{0.5};    ///< [m/s^2] at most, with which it comes to ends of its way
  double error_distance{0.4};  ///< [m] in which it takes errors of its course back
  double farthest{0.4};        ///< [m] off its way, or ...
  double farthest_turn{0.8};   ///< [rad] ... off its course: the way is lost
};

/// Drives a base that steers like a car along a path of arcs, forward and backward: steering as the
/// path does a little further on, and so that errors vanish like those of a critically damped
/// oscillator along the way [Samson 1995, IEEE Trans. Robotics and Automation 11:64-77]; as fast as
/// the motion set and the changes of curvature ahead allow. Where the path changes direction it
/// stops first. The same calls give the same velocities. A value: a copy goes on by itself.
class CarFollower {
 public:
  /// @param footprint  Convex, padded, in the base frame [m].
  /// @pre periods, tolerances and distances > 0, min_turning_radius > 0 [m].
  CarFollower(const CarFollowerParams& params, const Footprint& footprint,
              double min_turning_radius);

  void SetPath(std::vector<CarPose> path);            ///< its last pose is the goal @pre not empty
  void SetMotionSet(const robot::MotionSet& limits);  ///< @pre finite, >= 0

  /// One control cycle.
  /// kDriving: drive at the velocity given, which no arc is too sharp for. If something stands on
  /// the way ahead, it brakes within the limits. kNoValidTrajectory: it stands out of tolerance
  /// with something in its way, or off its way, or at its end: it needs a new one. kGoalReached: it
  /// stands so, or at the end of its way, within both tolerances of the goal.
  /// @param costmap  nothing: it drives without looking.
  /// @pre SetPath was called.
  DwaResult Update(const Costmap* costmap, const geometry::Pose2& X_MB,
                   const geometry::Twist2& V_B);

  double remaining() const;  ///< [m] of the path, at the last update
  /// At the last update, by what stands in its way.
  bool is_blocked() const { return is_blocked_; }

 private:
  std::size_t EndOfLeg() const;
  double Sign() const;
  bool IsStopped(const geometry::Twist2& V_B) const;
  bool IsLost() const;
  void FindPlace(const geometry::Pose2& X_MB);
  void PlanSpeeds();
  double Deceleration() const;
  double MeanCurvature(double from, double to) const;
  double CurvatureFor(double speed) const;
  double SpeedFor(double speed_now) const;
  geometry::Twist2 Velocity(const geometry::Twist2& V_B) const;
  geometry::Twist2 Braked(const geometry::Twist2& V_B) const;
  bool IsFree(const Costmap& costmap, const geometry::Pose2& X_MB, const geometry::Twist2& V_B);
  DwaResult AtRest(const geometry::Pose2& X_MB) const;

  CarFollowerParams params_;
  Footprint footprint_;
  double sharpest_;  // [1/m]
  robot::MotionSet limits_;
  std::vector<CarPose> path_;
  std::vector<double> along_;    // [m] from the path's begin to each pose
  std::vector<double> fastest_;  // [m/s] at each pose, stops aside
  std::size_t leg_{0};           // pose from which it drives in one direction
  std::size_t nearest_{0};       // pose of that leg
  double place_{0.0};            // [m] along the path
  double lateral_{0.0};          // [m] of the base to the left of the path
  double heading_{0.0};          // [rad] of the base off the path's
  bool is_ending_{false};        // it brakes at the end of its leg
  bool is_blocked_{false};
};

}  // namespace hires::navigation
