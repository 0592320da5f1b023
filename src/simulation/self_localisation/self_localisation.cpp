#include "hires/simulation/self_localisation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hires/base/error.h"
#include "simulation/start_checks.h"

namespace hires::simulation {
namespace {

using geometry::Pose2;

constexpr double kSlice = 0.02;  // [m] above and below the laser's plane
enum Streams : std::uint64_t { kWheels, kGyro, kScans, kFilter, kStart, kCarried, kFloor };

localisation::MonteCarloLocalisation FilterIn(const SelfLocalisationParams& params,
                                              const world::World& world, double laser_height) {
  const world::OccupancyGrid map = MapIn(params, world, laser_height);
  const std::string why = localisation::WhyUseless(map);
  if (!why.empty()) throw base::ConfigError("the world in the plane of the base's laser " + why);
  return {map, params.filter, base::Rng(0)};
}

/// Where a robot was before it was carried to X_MB.
Pose2 MistakenFor(const SelfLocalisationParams& params, const Pose2& X_MB, base::Rng rng) {
  std::vector<Pose2> places;
  for (const Pose2& place : params.mistaken_for)
    if ((place.position() - X_MB.position()).norm() >= kCarriedAway) places.push_back(place);
  return places.empty() ? X_MB : places[rng.Index(static_cast<int>(places.size()))];
}

/// Of the start that the robot is told.
Pose2 StartError(const SelfLocalisationParams& params, base::Rng rng) {
  const double x = rng.Normal(0.0, params.start_sd), y = rng.Normal(0.0, params.start_sd);
  return {x, y, rng.Normal(0.0, params.start_sd_yaw)};
}

}  // namespace

world::OccupancyGrid MapIn(const SelfLocalisationParams& params, const world::World& world,
                           double laser_height) {
  return world::SliceWorld(world, laser_height - kSlice, laser_height + kSlice,
                           params.map_resolution);
}

SelfLocalisation::SelfLocalisation(const SelfLocalisationParams& params, const world::World& world,
                                   double laser_height)
    : params_(params), filter_(FilterIn(params, world, laser_height)) {
  params_.laser.num_beams = std::min(params.laser.num_beams, params.filter.laser_max_beams);
}

std::shared_ptr<const Scene> FindingItsPlace(Scene scene, const SelfLocalisationParams& params,
                                             const world::World& mapped) {
  if (!scene.laser_height || !scene.surroundings) {
    throw base::ConfigError(
        "a robot that finds its place by itself needs a base laser (laser_link of its profile) and "
        "an upper body; let it be told (localisation: fitted)");
  }
  RefuseTiltedLaser(scene.robot);
  scene.self_localisation =
      std::make_shared<const SelfLocalisation>(params, mapped, *scene.laser_height);
  return std::make_shared<const Scene>(std::move(scene));
}

SelfLocaliser::SelfLocaliser(std::shared_ptr<const SelfLocalisation> common, const Pose2& X_MB,
                             const base::Rng& rng)
    : common_(std::move(common)),
      gyro_rng_(rng.Fork(kGyro)),
      scan_rng_(rng.Fork(kScans)),
      wheels_(params().casters, rng.Fork(kWheels)),
      odometry_(params().odometry),
      filter_(common_->filter()),
      X_MBtrue_(X_MB),
      bias_(gyro_rng_.Normal(0.0, params().gyro.bias)),
      floor_rng_(rng.Fork(kFloor)) {
  const double variance = params().start_sd * params().start_sd;
  const double variance_yaw = params().start_sd_yaw * params().start_sd_yaw;
  filter_.Reseed(rng.Fork(kFilter));
  filter_.SetPose(
      MistakenFor(params(), X_MB, rng.Fork(kCarried)) * StartError(params(), rng.Fork(kStart)),
      Eigen::Vector3d(variance, variance, variance_yaw).asDiagonal());
  odometry_.OnInertia(now(), {});
  odometry_.OnOdometry(now(), {});
}

/// A motion as the wheels make it: on a wet patch they spin.
Pose2 SelfLocaliser::Spun(const Pose2& X_AB) {
  const WetPatch* under = nullptr;
  for (const WetPatch& patch : params().wet)
    if ((X_MBtrue_.position() - patch.at_M).norm() <= patch.radius) under = &patch;
  if (under != nullptr && !is_on_wet_) spin_ = floor_rng_.Normal(0.0, under->spin);
  is_on_wet_ = under != nullptr;
  if (!is_on_wet_) return X_AB;
  return {(1.0 + spin_) * X_AB.x, (1.0 + spin_) * X_AB.y, (1.0 + spin_) * X_AB.yaw};
}

void SelfLocaliser::Drive(double time, const Pose2& X_MB) {
  const double dt = time - time_;
  if (dt <= 0.0) return;
  time_ = time;
  const Pose2 X_AB = X_MBtrue_.Inverse() * X_MB;
  X_MBtrue_ = X_MB;
  wheels_.Roll(Spun(X_AB));
  const double root = std::sqrt(dt);
  const double turned = X_AB.yaw + bias_ * dt + gyro_rng_.Normal(0.0, params().gyro.walk * root);
  bias_ += gyro_rng_.Normal(0.0, params().gyro.bias_walk * root);
  heading_ += turned;
  odometry_.OnInertia(now(), {heading_, turned / dt});
  odometry_.OnOdometry(now(), {wheels_.X_OB(), {X_AB.x / dt, X_AB.y / dt, turned / dt}});
  X_OB_ = odometry_.X_FB();
}

void SelfLocaliser::PutAt(double time, const Pose2& X_MB) {
  offset_ += time_ - time;
  time_ = time;
  X_MBtrue_ = X_MB;
}

bool SelfLocaliser::wants_scan() const {
  if (scanned_ && now() <= *scanned_) return false;
  return !scanned_ || now() - *scanned_ >= params().scan_period || filter_.WouldUse(X_OB_);
}

void SelfLocaliser::Hear(const robot::ScanReading& scan, const Pose2& X_BL) {
  scanned_ = now();
  filter_.Update(now(), X_OB_, scan, X_BL);
}

Pose2 SelfLocaliser::X_MB() const { return filter_.CorrectedOdometry() * X_OB_; }

localisation::PoseEstimate SelfLocaliser::Estimate() const {
  localisation::PoseEstimate estimate = filter_.Estimate(now());
  estimate.X_MB = X_MB();
  return estimate;
}

}  // namespace hires::simulation
