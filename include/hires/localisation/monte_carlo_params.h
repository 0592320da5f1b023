#pragma once

#include <Eigen/Core>

#include "hires/base/param_reader.h"
#include "hires/geometry/pose.h"
#include "hires/localisation/live_scan_params.h"
#include "hires/localisation/odometry_model.h"
#include "hires/robot/odometry_jump.h"

namespace hires::localisation {

/// AMCL's parameters by their AMCL names where they mean the same; those of ours stand below.
struct MonteCarloParams {
  int min_particles{500}, max_particles{5000};
  double kld_err{0.05};  ///< error of the belief that the number of particles allows
  double kld_z{0.99};    ///< standard normal quantile with which it does

  double update_min_d{0.2};  ///< [m] driven before a scan is used
  double update_min_a{0.5};  ///< [rad] turned before a scan is used
  int resample_interval{1};  ///< scans that are used before particles are drawn
  double recovery_alpha_slow{0.001}, recovery_alpha_fast{0.1};  ///< both 0: no random particles

  int laser_max_beams{60};
  double laser_z_hit{0.5}, laser_z_rand{0.5};
  double laser_sigma_hit{0.2};            ///< [m]
  double laser_likelihood_max_dist{2.0};  ///< [m]
  double laser_min_range{-1.0};           ///< [m] -1: as the scan says
  double laser_max_range{-1.0};           ///< [m] -1: as the scan says

  OdometryModelParams odometry;  ///< odom_model_type, odom_alpha1..5

  geometry::Pose2 initial_pose;                          ///< initial_pose_x, _y, _a
  Eigen::Vector3d initial_variance{0.25, 0.25, 0.0685};  ///< initial_cov_xx, _yy [m^2], _aa [rad^2]

  /// A scan counts as much as so many beams, if it has more. Beams of one scan err alike (the map
  /// is wrong where they all end, the pose is that of one moment), and as many independent
  /// measurements they would make the filter far too sure of itself.
  double independent_beams{10.0};
  int global_particles{50000};  ///< that begin a global localisation; the first scan sifts them
  double max_linear_speed{robot::kFastestDrive};  ///< [m/s] odometry that is faster was reset
  double max_angular_speed{robot::kFastestTurn};  ///< [rad/s]
  double explained_distance{0.2};  ///< [m] beams that end so near to an obstacle are explained
  double lost_explained{0.5};      ///< share of explained beams below which it is lost
  double lost_spread{1.0};  ///< [m] standard deviation of the position above which it is lost
  /// [s] of scans that say that it is lost, after which it looks everywhere; negative: never
  double relocate_after{3.0};
  double scan_timeout{5.0};  ///< [s] without a scan that can be used, after which it says so
};

/// config/localisation.yaml
struct LocalisationConfig {
  MonteCarloParams filter;
  LiveScanParams node;
};

/// @throws base::ConfigError naming the key
LocalisationConfig ReadLocalisationConfig(base::ParamReader in);

}  // namespace hires::localisation
