#include "hires/localisation/monte_carlo_params.h"

namespace hires::localisation {
namespace {

using base::Between;

void ReadParticles(base::ParamReader* in, MonteCarloParams* params) {
  constexpr int kMost = 1000000;
  params->min_particles = in->Get("min_particles", Between(1, kMost));
  params->max_particles = in->Get("max_particles", Between(1, kMost));
  if (params->max_particles < params->min_particles) {
    in->Fail("max_particles", "less than min_particles, wanted as many or more");
  }
  params->kld_err = in->Get("kld_err", Between(1e-4, 1.0));
  params->kld_z = in->Get("kld_z", Between(0.0, 5.0));
  params->update_min_d = in->Get("update_min_d", Between(0.0, 10.0));
  params->update_min_a = in->Get("update_min_a", Between(0.0, 6.3));
  params->resample_interval = in->Get("resample_interval", Between(1, 1000));
  params->recovery_alpha_slow = in->Get("recovery_alpha_slow", Between(0.0, 1.0));
  params->recovery_alpha_fast = in->Get("recovery_alpha_fast", Between(0.0, 1.0));
}

void ReadLaser(base::ParamReader* in, MonteCarloParams* params) {
  params->laser_max_beams = in->Get("laser_max_beams", Between(2, 10000));
  params->laser_z_hit = in->Get("laser_z_hit", Between(1e-3, 1.0));
  params->laser_z_rand = in->Get("laser_z_rand", Between(0.0, 1.0));
  params->laser_sigma_hit = in->Get("laser_sigma_hit", Between(1e-3, 10.0));
  params->laser_likelihood_max_dist = in->Get("laser_likelihood_max_dist", Between(0.01, 100.0));
  params->laser_min_range = in->Get("laser_min_range", Between(-1.0, 1000.0));
  params->laser_max_range = in->Get("laser_max_range", Between(-1.0, 1000.0));
}

void ReadOdometry(base::ParamReader* in, OdometryModelParams* params) {
  params->kind = MotionKindOf(in->Get(
      "odom_model_type", base::OneOf({"diff", "omni", "diff-corrected", "omni-corrected"})));
  params->alpha1 = in->Get("odom_alpha1", Between(0.0, 100.0));
  params->alpha2 = in->Get("odom_alpha2", Between(0.0, 100.0));
  params->alpha3 = in->Get("odom_alpha3", Between(0.0, 100.0));
  params->alpha4 = in->Get("odom_alpha4", Between(0.0, 100.0));
  params->alpha5 = in->Get("odom_alpha5", Between(0.0, 100.0));
}

void ReadInitial(base::ParamReader* in, MonteCarloParams* params) {
  params->initial_pose.x = in->Get("initial_pose_x", Between(-1e5, 1e5));
  params->initial_pose.y = in->Get("initial_pose_y", Between(-1e5, 1e5));
  params->initial_pose.yaw = in->Get("initial_pose_a", Between(-6.3, 6.3));
  params->initial_variance.x() = in->Get("initial_cov_xx", Between(0.0, 1e6));
  params->initial_variance.y() = in->Get("initial_cov_yy", Between(0.0, 1e6));
  params->initial_variance.z() = in->Get("initial_cov_aa", Between(0.0, 40.0));
}

void ReadOurs(base::ParamReader* in, MonteCarloParams* params) {
  params->independent_beams = in->Get("independent_beams", Between(0.1, 10000.0));
  params->global_particles = in->Get("global_particles", Between(1, 5000000));
  params->max_linear_speed = in->Get("max_linear_speed", Between(0.01, 100.0));
  params->max_angular_speed = in->Get("max_angular_speed", Between(0.01, 100.0));
  params->explained_distance = in->Get("explained_distance", Between(0.01, 10.0));
  params->lost_explained = in->Get("lost_explained", Between(0.0, 1.0));
  params->lost_spread = in->Get("lost_spread", Between(0.01, 1000.0));
  params->relocate_after = in->Get("relocate_after", Between(-1.0, 3600.0));
  params->scan_timeout = in->Get("scan_timeout", Between(0.1, 3600.0));
}

}  // namespace

LiveScanParams ReadLiveScanParams(base::ParamReader* in) {
  LiveScanParams params;
  params.tf_broadcast = in->GetBool("tf_broadcast");
  params.transform_tolerance = in->Get("transform_tolerance", Between(0.0, 10.0));
  params.max_age = in->Get("max_age", Between(0.1, 3600.0));
  params.max_ahead = in->Get("max_ahead", Between(0.0, 10.0));
  return params;
}

LocalisationConfig ReadLocalisationConfig(base::ParamReader in) {
  LocalisationConfig config;
  ReadParticles(&in, &config.filter);
  ReadLaser(&in, &config.filter);
  ReadOdometry(&in, &config.filter.odometry);
  ReadInitial(&in, &config.filter);
  ReadOurs(&in, &config.filter);
  base::ParamReader node = in.Sub("node");
  config.node = ReadLiveScanParams(&node);
  in.RejectUnknownKeys();
  return config;
}

}  // namespace hires::localisation
