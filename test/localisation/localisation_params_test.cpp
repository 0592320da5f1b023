#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hires/base/error.h"
#include "hires/localisation/monte_carlo_params.h"
#include "hires/localisation/odometry_filter.h"

namespace hires::localisation::localisation_params_test {
namespace {

using base::ParamReader;
using ::testing::HasSubstr;

const std::string kMonteCarlo = R"(
min_particles: 100
max_particles: 2000
kld_err: 0.05
kld_z: 0.99
update_min_d: 0.2
update_min_a: 0.5
resample_interval: 2
recovery_alpha_slow: 0.001
recovery_alpha_fast: 0.1
laser_max_beams: 30
laser_z_hit: 0.95
laser_z_rand: 0.05
laser_sigma_hit: 0.2
laser_likelihood_max_dist: 2.0
laser_min_range: -1.0
laser_max_range: 12.0
odom_model_type: diff-corrected
odom_alpha1: 0.1
odom_alpha2: 0.2
odom_alpha3: 0.3
odom_alpha4: 0.4
odom_alpha5: 0.5
initial_pose_x: 1.0
initial_pose_y: -2.0
initial_pose_a: 0.7
initial_cov_xx: 0.25
initial_cov_yy: 0.16
initial_cov_aa: 0.07
independent_beams: 10.0
global_particles: 50000
max_linear_speed: 2.0
max_angular_speed: 6.0
explained_distance: 0.3
lost_explained: 0.4
lost_spread: 1.0
relocate_after: 3.0
scan_timeout: 5.0
node:
  tf_broadcast: false
  transform_tolerance: 0.2
  max_age: 4.0
  max_ahead: 0.25
)";

const std::string kFilter = R"(
position_per_metre: 4.0e-4
position_per_radian: 1.0e-4
yaw_per_metre: 4.0e-4
yaw_per_radian: 4.0e-3
imu_yaw_sd: 1.0e-3
imu_drift: 1.0e-7
imu_timeout: 1.0
odometry_timeout: 1.0
max_linear_speed: 2.0
max_angular_speed: 6.0
jump_position_sd: 0.2
jump_yaw_sd: 0.3
node:
  tf_broadcast: false
  imu_used: true
  imu_wait: 0.02
)";

std::string With(std::string text, const std::string& line, const std::string& instead) {
  return text.replace(text.find(line), line.size(), instead);
}

std::string ConfigErrorOf(const std::string& text) {
  try {
    ReadLocalisationConfig(ParamReader::FromString(text, "test.yaml"));
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(LocalisationConfigTest, ValuesOfABlockAreRead) {
  const LocalisationConfig config =
      ReadLocalisationConfig(ParamReader::FromString(kMonteCarlo, "test.yaml"));
  const MonteCarloParams& params = config.filter;
  EXPECT_EQ(params.max_particles, 2000);
  EXPECT_EQ(params.resample_interval, 2);
  EXPECT_EQ(params.laser_max_range, 12.0);
  EXPECT_EQ(params.odometry.kind, MotionKind::kDiffCorrected);
  EXPECT_EQ(params.odometry.alpha4, 0.4);
  EXPECT_EQ(params.initial_pose.y, -2.0);
  EXPECT_EQ(params.initial_variance, Eigen::Vector3d(0.25, 0.16, 0.07));
  EXPECT_FALSE(config.node.tf_broadcast);
  EXPECT_EQ(config.node.transform_tolerance, 0.2);
  EXPECT_EQ(config.node.max_age, 4.0);
  EXPECT_EQ(config.node.max_ahead, 0.25);
}

TEST(LocalisationConfigTest, KeysThatAreMissingUnknownOrOutOfBoundsAreNamed) {
  EXPECT_THAT(ConfigErrorOf(With(kMonteCarlo, "kld_z: 0.99\n", "")), HasSubstr("kld_z"));
  EXPECT_THAT(ConfigErrorOf(kMonteCarlo + "beam_skip: 1\n"), HasSubstr("beam_skip"));
  EXPECT_THAT(ConfigErrorOf(With(kMonteCarlo, "laser_sigma_hit: 0.2", "laser_sigma_hit: 0.0")),
              HasSubstr("laser_sigma_hit"));
  EXPECT_THAT(ConfigErrorOf(With(kMonteCarlo, "diff-corrected", "tracked")),
              HasSubstr("odom_model_type"));
  EXPECT_THAT(ConfigErrorOf(With(kMonteCarlo, "max_particles: 2000", "max_particles: 50")),
              HasSubstr("max_particles"));
  EXPECT_THAT(ConfigErrorOf(With(kMonteCarlo, "max_ahead", "max_future")),
              HasSubstr("node.max_ahead"));
}

TEST(OdometryFilterConfigTest, ValuesOfABlockAreRead) {
  const OdometryFilterConfig config =
      ReadOdometryFilterConfig(ParamReader::FromString(kFilter, "test.yaml"));
  EXPECT_EQ(config.filter.yaw_per_radian, 4e-3);
  EXPECT_EQ(config.filter.jump_position_sd, 0.2);
  EXPECT_EQ(config.filter.jump_yaw_sd, 0.3);
  EXPECT_FALSE(config.node.tf_broadcast);
  EXPECT_TRUE(config.node.imu_used);
  EXPECT_EQ(config.node.imu_wait, 0.02);
}

TEST(OdometryFilterConfigTest, UnknownKeysAreRefused) {
  EXPECT_THROW(ReadOdometryFilterConfig(ParamReader::FromString("gps: 1\n" + kFilter, "test.yaml")),
               base::ConfigError);
  EXPECT_THROW(
      ReadOdometryFilterConfig(ParamReader::FromString(kFilter + "  gps: 1\n", "test.yaml")),
      base::ConfigError);
}

}  // namespace
}  // namespace hires::localisation::localisation_params_test
