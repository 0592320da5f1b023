#include "hires/simulation/self_localisation.h"

#include <algorithm>
#include <utility>

#include "hires/base/error.h"
#include "simulation/self_localisation/streams.h"
#include "simulation/start_checks.h"

namespace hires::simulation {
namespace {

using geometry::Pose2;

constexpr double kSlice = 0.02;  // [m] above and below the laser's plane

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

Pose2 BelievedStart(const SelfLocalisationParams& params, const Pose2& X_MB, const base::Rng& rng) {
  return MistakenFor(params, X_MB, rng.Fork(place_stream::kCarried)) *
         StartError(params, rng.Fork(place_stream::kStart));
}

Eigen::Matrix3d StartCovariance(const SelfLocalisationParams& params) {
  const double variance = params.start_sd * params.start_sd;
  const double variance_yaw = params.start_sd_yaw * params.start_sd_yaw;
  return Eigen::Vector3d(variance, variance, variance_yaw).asDiagonal();
}

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
  if (!scene.laser_height) {
    throw base::ConfigError(
        "a robot that finds its place by itself needs a base laser (laser_link of its profile); "
        "let it be told (localisation: fitted)");
  }
  RefuseTiltedLaser(scene.robot);
  scene.self_localisation =
      std::make_shared<const SelfLocalisation>(params, mapped, *scene.laser_height);
  return std::make_shared<const Scene>(std::move(scene));
}

SelfLocaliser::SelfLocaliser(std::shared_ptr<const SelfLocalisation> common, const Pose2& X_MB,
                             const base::Rng& rng)
    : common_(std::move(common)),
      scan_rng_(rng.Fork(place_stream::kScans)),
      motion_({common_, &common_->params()}, X_MB, rng),
      odometry_(params().odometry),
      filter_(common_->filter()) {
  filter_.Reseed(rng.Fork(place_stream::kFilter));
  filter_.SetPose(BelievedStart(params(), X_MB, rng), StartCovariance(params()));
  odometry_.OnInertia(now(), {});
  odometry_.OnOdometry(now(), {});
}

void SelfLocaliser::Drive(double time, const Pose2& X_MB) {
  const double dt = time - time_;
  if (dt <= 0.0) return;
  time_ = time;
  motion_.Drive(dt, X_MB);
  odometry_.OnInertia(now(), motion_.inertia());
  odometry_.OnOdometry(now(), motion_.odometry());
  X_OB_ = odometry_.X_FB();
}

void SelfLocaliser::PutAt(double time, const Pose2& X_MB) {
  offset_ += time_ - time;
  time_ = time;
  motion_.PutAt(X_MB);
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
