#pragma once

#include <vector>

#include "hires/geometry/polygon.h"
#include "hires/geometry/pose.h"
#include "hires/navigation/costmap.h"
#include "hires/robot/robot_profile.h"

namespace hires::navigation {

/// Defaults: the PR2's navigation configuration of 2015.
struct DwaParams {
  double control_period{0.1};         ///< [s] 1 / controller_frequency
  double min_linear_velocity{0.1};    ///< [m/s] min_trans_vel
  double max_lateral_velocity{0.1};   ///< [m/s] max_vel_y
  double min_angular_velocity{0.3};   ///< [rad/s] min_rot_vel
  double sim_time{1.7};               ///< [s] length of a simulated trajectory
  double sim_granularity{0.025};      ///< [m] between two checked poses
  double angular_sim_granularity{0.1};  ///< [rad]
  double path_distance_bias{24.0};
  double goal_distance_bias{32.0};
  double obstacle_scale{0.01};        ///< occdist_scale
  double stop_time_buffer{0.2};       ///< [s]
  double forward_point_distance{0.325};  ///< [m]
  double scaling_speed{0.25};         ///< [m/s] above which the footprint grows
  double max_scaling_factor{0.2};
  double oscillation_reset_distance{0.05};  ///< [m]
  double oscillation_reset_angle{0.2};      ///< [rad]
  double xy_goal_tolerance{0.2};      ///< [m]
  double yaw_goal_tolerance{0.17};    ///< [rad]
  double stopped_linear_velocity{0.01};   ///< [m/s] trans_stopped_vel
  double stopped_angular_velocity{0.01};  ///< [rad/s]
  int vx_samples{3};
  int vy_samples{10};
  int vtheta_samples{20};
};

enum class DwaStatus { kDriving, kGoalReached, kNoValidTrajectory };

struct DwaResult {
  DwaStatus status{DwaStatus::kNoValidTrajectory};
  geometry::Twist2 velocity;  ///< to be commanded, in the base frame; zero unless driving
  int num_samples{0};         ///< velocities that were scored
};

/// Local control by the dynamic window approach [Fox, Burgard, Thrun 1997, IEEE RAM 4:23-33] with
/// the critics of dwa_local_planner: obstacles under the footprint, distance to the path and to the
/// local goal of base and forward point, oscillation. At the goal's position it stops and turns.
class DwaPlanner {
 public:
  DwaPlanner(const DwaParams& params, const geometry::Polygon& footprint);

  void SetPath(std::vector<geometry::Pose2> path);  ///< a new goal: its last pose
  void SetMotionSet(const robot::MotionSet& limits);

  DwaResult Update(const Costmap& costmap, const geometry::Pose2& X_MB,
                   const geometry::Twist2& V_B);

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace hires::navigation
