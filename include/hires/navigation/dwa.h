#pragma once

#include <memory>
#include <vector>

#include "hires/geometry/polygon.h"
#include "hires/geometry/pose.h"
#include "hires/navigation/costmap.h"
#include "hires/robot/robot_profile.h"

namespace hires::navigation {

/// Defaults: the PR2's navigation configuration of 2015.
struct DwaParams {
  double control_period{0.1};           ///< [s] 1 / controller_frequency
  double min_linear_velocity{0.1};      ///< [m/s] min_trans_vel
  double max_lateral_velocity{0.1};     ///< [m/s] max_vel_y; 0: a base that cannot
  double min_angular_velocity{0.3};     ///< [rad/s] min_rot_vel
  double sim_time{1.7};                 ///< [s] length of a simulated trajectory
  double sim_granularity{0.025};        ///< [m] between two checked poses
  double angular_sim_granularity{0.1};  ///< [rad]
  double path_distance_bias{24.0};      ///< per cell; all three as the version of 2015 weighs them:
  double goal_distance_bias{32.0};      ///< half the biases and the whole obstacle scale times the
  double obstacle_scale{0.01};          ///< cell's size; occdist_scale, per unit of cost
  double stop_time_buffer{0.2};  ///< [s] trajectories last at least as long as stopping takes,
                                 ///< plus this much
  double forward_point_distance{0.325};  ///< [m]
  double scaling_speed{0.25};            ///< [m/s] above which the footprint grows
  double max_scaling_factor{0.2};
  double oscillation_reset_distance{0.05};  ///< [m]
  double oscillation_reset_angle{0.2};      ///< [rad]
  double xy_goal_tolerance{0.2};            ///< [m]
  double yaw_goal_tolerance{0.17};          ///< [rad]
  double stopped_linear_velocity{0.01};     ///< [m/s] trans_stopped_vel
  double stopped_angular_velocity{0.01};    ///< [rad/s]
  int vx_samples{3};
  int vy_samples{10};
  int vtheta_samples{20};
};

/// [m] The local planner sees the costmap so far to each side; the original's local costmap is
/// 6 m x 6 m.
constexpr double kLocalHalfWidth = 3.0;

enum class DwaStatus { kDriving, kGoalReached, kNoValidTrajectory };

struct DwaResult {
  DwaStatus status{DwaStatus::kNoValidTrajectory};
  geometry::Twist2 velocity;  ///< to be commanded, in the base frame; zero unless driving
  int num_samples{0};         ///< velocities that were scored
};

/// Local control by the dynamic window approach [Fox, Burgard, Thrun 1997, IEEE RAM 4:23-33] with
/// the critics of dwa_local_planner: obstacles under the footprint, distance to the path and to the
/// local goal of base and forward point, oscillation. At the goal's position it stops and turns; if
/// the turn would touch something, it first creeps to a place within the goal's tolerance where it
/// does not. A base that cannot move sideways stops well inside of the tolerance. Where it came to
/// rest out of tolerance after all, for its believed place moved, a brisk base that moves sideways
/// is brought back by the window; every other one, and that one if it misses again or swings beside
/// its goal, creeps there straight, or turns, drives what is missing and turns back. A base that
/// cannot move sideways and comes no further on its way, or stands without a valid velocity there,
/// turns and drives straight, forward and backward, to where its way goes on. No velocity is ever
/// given whose footprint touches an obstacle, its interior included. The same calls give the same
/// velocities. A copy goes on from the same state on its own.
class DwaPlanner {
 public:
  /// @param footprint  Convex, padded, in the base frame [m].
  /// @pre periods, granularities and tolerances > 0, all other parameters >= 0.
  DwaPlanner(const DwaParams& params, const Footprint& footprint);
  DwaPlanner(const DwaPlanner& other);
  DwaPlanner& operator=(const DwaPlanner& other);
  ~DwaPlanner();

  /// A new goal: its last pose. @pre not empty.
  void SetPath(const std::vector<geometry::Pose2>& path);
  void SetMotionSet(const robot::MotionSet& limits);  ///< @pre finite, >= 0
  /// [m] From now on kept free round the footprint where possible; half of it where that is not,
  /// and else what is kept free in any case. @pre finite, >= 0
  void SetMargin(double margin);

  /// One control cycle.
  /// kDriving: drive at the velocity given; if every way on leads to contact, it brakes within the
  /// limits.
  /// kNoValidTrajectory: the robot stands and every way leads to contact, or braking within the
  /// limits is not enough, or the robot touches something, or its path is out of sight
  /// (kLocalHalfWidth); the caller stops at once and decides how to recover. kGoalReached: the
  /// robot stands still within both tolerances.
  /// @param X_MB  where the robot stands; @param V_B  its velocity in the base frame.
  /// @pre SetPath was called.
  DwaResult Update(const Costmap& costmap, const geometry::Pose2& X_MB,
                   const geometry::Twist2& V_B);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hires::navigation
