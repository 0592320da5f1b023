#include "hires/localisation/monte_carlo.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "hires/base/error.h"
#include "hires/geometry/angles.h"
#include "hires/robot/odometry_jumps.h"
#include "localisation/beams.h"
#include "localisation/belief_summary.h"
#include "localisation/likelihood_field.h"
#include "localisation/particles.h"

namespace hires::localisation {

using geometry::Pose2;

/// What never changes, shared by all copies of a belief.
struct KnownMap {
  KnownMap(const world::OccupancyGrid& grid, double max_distance)
      : grid(grid), field(grid, max_distance) {
    for (std::size_t i = 0; i < grid.cells.size(); ++i) {
      if (grid.cells[i] == world::Cell::kFree) free_cells.push_back(static_cast<int>(i));
    }
  }

  Pose2 AnyFreePose(base::Rng* rng) const {
    const int cell = free_cells[rng->Index(static_cast<int>(free_cells.size()))];
    const double column = cell % grid.width + rng->Uniform(0.0, 1.0);
    const double row = cell / grid.width + rng->Uniform(0.0, 1.0);
    return {grid.origin.x() + column * grid.resolution, grid.origin.y() + row * grid.resolution,
            rng->Uniform(-geometry::kPi, geometry::kPi)};
  }

  world::OccupancyGrid grid;
  LikelihoodField field;
  std::vector<int> free_cells;
};

struct OdometryAnchor {
  double time;
  Pose2 X_OB;
};

namespace {

constexpr double kFarthest = 1e6;       // [m] poses beyond are no poses
constexpr double kExplainedRate = 0.3;  // at which the share of explained beams is averaged
// While particles are spread over several places, the one nearest to the robot may be 0.3 m and 10
// degrees off and fit worse than luckier ones elsewhere; a scan then counts as so few beams that
// several scans decide.
constexpr double kBeamsWhileUndecided = 2.0;
// Of the belief, that stays where it was when it looks everywhere.
constexpr double kKeptShare = 0.1;
constexpr double kAnyRange = 30.0;  // [m] where neither scan nor parameters name a longest range

bool IsPose(const Pose2& X) {
  return X.IsFinite() && std::abs(X.x) < kFarthest && std::abs(X.y) < kFarthest;
}

/// A root L of the covariance, L L' = covariance, also where it is singular.
Eigen::Matrix3d RootOf(const Eigen::Matrix3d& covariance) {
  constexpr double kRounding = 1e-9;
  if (covariance.allFinite() && covariance.isApprox(covariance.transpose(), 1e-6)) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
    if (solver.eigenvalues().minCoeff() >= -kRounding) {
      return solver.eigenvectors() *
             solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal().toDenseMatrix();
    }
  }
  throw base::ConfigError(
      "the covariance of a pose is not symmetric, negative or no number; wanted variances of x, y "
      "[m^2] and yaw [rad^2] on its diagonal");
}

}  // namespace

std::string ToString(LocalisationStatus status) {
  switch (status) {
    case LocalisationStatus::kGood:
      return "good";
    case LocalisationStatus::kAmbiguous:
      return "ambiguous";
    case LocalisationStatus::kUnexplained:
      return "unexplained";
    case LocalisationStatus::kSpread:
      return "spread";
    case LocalisationStatus::kNoScan:
      return "no scan";
  }
  return "unknown";
}

std::string WhyUseless(const world::OccupancyGrid& map) {
  const auto has = [&](world::Cell cell) {
    return std::find(map.cells.begin(), map.cells.end(), cell) != map.cells.end();
  };
  if (!has(world::Cell::kFree)) {
    return "has no free cell, so the robot can be nowhere; is free space marked as unknown "
           "(free_thresh)?";
  }
  if (!has(world::Cell::kOccupied)) {
    return "has no occupied cell, so no laser tells where the robot is; are obstacles marked as "
           "unknown (occupied_thresh)?";
  }
  return "";
}

Eigen::AlignedBox2d ExtentOf(const world::OccupancyGrid& map) {
  const Eigen::Vector2d size = map.resolution * Eigen::Vector2d(map.width, map.height);
  return {map.origin, map.origin + size};
}

std::string WhyOutside(const Pose2& X_MB, const Eigen::AlignedBox2d& extent) {
  const Eigen::Vector2d p_MB = X_MB.position();
  if (!p_MB.allFinite() || extent.contains(p_MB)) return "";
  return fmt::format(
      "x {:.6g} m, y {:.6g} m lies outside of the map, which reaches from x {:.6g} to {:.6g} m and "
      "from y {:.6g} to {:.6g} m",
      p_MB.x(), p_MB.y(), extent.min().x(), extent.max().x(), extent.min().y(), extent.max().y());
}

class MonteCarloLocalisation::Belief {
 public:
  Belief(const world::OccupancyGrid& grid, const MonteCarloParams& params, base::Rng rng)
      : map_(std::make_shared<KnownMap>(grid, params.laser_likelihood_max_dist)),
        params_(params),
        jumps_(params.max_linear_speed, params.max_angular_speed),
        beam_params_{params.laser_max_beams, params.laser_min_range, params.laser_max_range},
        rng_(rng) {
    SetPose(params.initial_pose, params.initial_variance.asDiagonal());
  }

  void SetPose(const Pose2& X_MB, const Eigen::Matrix3d& covariance) {
    if (!IsPose(X_MB)) throw base::ConfigError("a pose is no number, or beyond 1e6 m");
    const Eigen::Matrix3d root = RootOf(covariance);
    Begin();
    for (int i = 0; i < params_.max_particles; ++i) {
      Eigen::Vector3d unit;
      for (int axis = 0; axis < 3; ++axis) unit[axis] = rng_.Normal(0.0, 1.0);
      const Eigen::Vector3d off = root * unit;
      particles_.Add({X_MB.x + off.x(), X_MB.y + off.y(), X_MB.yaw + off.z()},
                     1.0 / params_.max_particles);
    }
    summary_ = SummariseAsOne(particles_);
  }

  void GlobalLocalisation() {
    if (map_->free_cells.empty()) {
      throw base::ConfigError(
          "the map has no free cell, so the robot can be nowhere; is free space marked as unknown "
          "(free_thresh of the map's YAML)?");
    }
    Begin();
    AddEverywhere(1.0);
    summary_ = SummariseAsOne(particles_);
  }

  void UseNextScan() { is_forced_ = true; }

  void Reseed(base::Rng rng) { rng_ = std::move(rng); }

  bool WouldUse(const Pose2& X_OB) const { return !used_ || IsDue(used_->X_OB.Inverse() * X_OB); }

  ScanOutcome Update(double time, const Pose2& X_OB, const robot::ScanReading& scan,
                     const Pose2& X_BL) {
    if (!std::isfinite(time) || !IsPose(X_OB)) return ScanOutcome::kNotFinite;
    const ScanOutcome followed = Follow(time, X_OB);
    if (followed != ScanOutcome::kUpdated) return followed;
    Beams beams;
    const ScanOutcome outcome = SelectBeams(scan, X_BL, beam_params_, &beams);
    const Pose2 moved = used_->X_OB.Inverse() * X_OB;
    if (outcome != ScanOutcome::kUpdated) {
      if (HasMoved(moved)) GoOnBlind(moved);
      return outcome;
    }
    last_scan_ = time;
    const bool is_due = IsDue(moved);
    if (is_due) Use(beams, moved, RangeMax(scan, beam_params_, kAnyRange));
    JudgeExplained(beams);
    if (IsLostForLong(time)) LookEverywhere();
    return is_due ? ScanOutcome::kUpdated : ScanOutcome::kNotMoved;
  }

  PoseEstimate Estimate(double time) const {
    PoseEstimate estimate;
    estimate.X_MB = seen_ ? CorrectedOdometry() * seen_->X_OB : summary_.X_MB;
    estimate.covariance = 0.5 * (summary_.covariance + summary_.covariance.transpose());
    estimate.num_particles = static_cast<int>(particles_.size());
    estimate.effective_size = effective_size_;
    estimate.num_clusters = summary_.num_clusters;
    estimate.best_share = summary_.best_share;
    estimate.explained = explained_;
    estimate.status = StatusAt(time);
    estimate.num_searches = num_searches_;
    if (estimate.status == LocalisationStatus::kUnexplained) {
      const double most = params_.lost_spread * params_.lost_spread;
      for (int axis = 0; axis < 3; ++axis)
        estimate.covariance(axis, axis) = std::max(estimate.covariance(axis, axis), most);
    }
    return estimate;
  }

  Pose2 CorrectedOdometry() const {
    return used_ ? summary_.X_MB * used_->X_OB.Inverse() : summary_.X_MB;
  }

  std::vector<Pose2> ParticlePoses() const {
    std::vector<Pose2> poses;
    for (std::size_t i = 0; i < particles_.size(); ++i) poses.push_back(particles_.pose(i));
    return poses;
  }

 private:
  /// @param weight  of all of them
  void AddEverywhere(double weight) {
    const int count = std::max(params_.global_particles, params_.max_particles);
    for (int i = 0; i < count; ++i) particles_.Add(map_->AnyFreePose(&rng_), weight / count);
  }

  /// Whether scans have said for long enough that it is lost. While it is still looking for its
  /// place, the mean of all places explains nothing.
  bool IsLostForLong(double time) {
    const bool is_looking = IsGlobal() || summary_.best_spread > params_.lost_spread;
    if (params_.relocate_after < 0.0 || is_looking || map_->free_cells.empty() || IsExplained())
      unexplained_since_.reset();
    else if (!unexplained_since_)
      unexplained_since_ = time;
    return unexplained_since_ && time - *unexplained_since_ >= params_.relocate_after;
  }

  void LookEverywhere() {
    const Particles before = std::move(particles_);
    const auto last_scan = last_scan_;
    Begin();
    for (std::size_t i = 0; i < before.size(); ++i)
      particles_.Add(before.pose(i), kKeptShare * before.weight[i]);
    AddEverywhere(1.0 - kKeptShare);
    summary_ = SummariseAsOne(particles_);
    last_scan_ = last_scan;
    unexplained_since_.reset();
    ++num_searches_;
  }

  /// A new belief, of a robot that stands where odometry saw it last.
  void Begin() {
    particles_ = {};
    used_ = seen_;
    last_scan_.reset();
    is_forced_ = true;
    explained_mean_.reset();
    explained_ = 0.0;
    slow_ = fast_ = 0.0;
    num_since_drawn_ = 0;
    effective_size_ = 0.0;
  }

  /// Goes on with the odometry. Where it is another one, what was driven since the last scan that
  /// was used stays driven.
  ScanOutcome Follow(double time, const Pose2& X_OB) {
    const OdometryAnchor now{time, X_OB};
    if (!seen_) {
      seen_ = used_ = now;
      return ScanOutcome::kUpdated;
    }
    const Pose2 step = seen_->X_OB.Inverse() * X_OB;
    const double duration = time - seen_->time;
    if (duration < 0.0 && duration > -robot::kClockReset) return ScanOutcome::kLate;
    const bool is_jump = duration >= 0.0 && jumps_.IsJump(step, duration);
    if (duration < 0.0 || is_jump) {
      used_ = OdometryAnchor{time, X_OB * (seen_->X_OB.Inverse() * used_->X_OB)};
      if (last_scan_) last_scan_ = std::min(*last_scan_, time);
      if (duration < 0.0) unexplained_since_.reset();
    }
    seen_ = now;
    return duration < 0.0 ? ScanOutcome::kTimeWentBack
           : is_jump      ? ScanOutcome::kOdometryJumped
                          : ScanOutcome::kUpdated;
  }

  bool IsDue(const Pose2& moved) const { return is_forced_ || HasMoved(moved); }

  bool HasMoved(const Pose2& moved) const {
    return std::hypot(moved.x, moved.y) >= params_.update_min_d ||
           std::abs(geometry::WrapToPi(moved.yaw)) >= params_.update_min_a;
  }

  /// By odometry alone, in steps as short as with scans, for which the model of its errors is made.
  void GoOnBlind(const Pose2& moved) {
    Move(moved);
    used_ = seen_;
    is_forced_ = true;  // the first scan that can be used is
    summary_ = IsGlobal() ? SummariseAsOne(particles_) : Summarise(particles_);
  }

  void Use(const Beams& beams, const Pose2& moved, double range_max) {
    Move(moved);
    used_ = seen_;
    is_forced_ = false;
    Weigh(beams, range_max);
    effective_size_ = EffectiveSize(particles_);
    // Too many to look for clusters: drawing sifts them.
    const bool is_global = IsGlobal();
    if (!is_global) summary_ = Summarise(particles_);
    if (is_global || ++num_since_drawn_ >= params_.resample_interval) Draw();
    if (is_global) summary_ = Summarise(particles_);
  }

  bool IsGlobal() const {
    return particles_.size() > static_cast<std::size_t>(params_.max_particles);
  }

  bool IsUndecided() const {
    return IsGlobal() || summary_.num_clusters != 1 || summary_.best_spread > params_.lost_spread;
  }

  void Move(const Pose2& X_AB) {
    const MotionSampler sampler(params_.odometry, X_AB);
    for (std::size_t i = 0; i < particles_.size(); ++i) {
      const Pose2 step = sampler.Sample(&rng_);
      const double c = std::cos(particles_.yaw[i]), s = std::sin(particles_.yaw[i]);
      particles_.x[i] += c * step.x - s * step.y;
      particles_.y[i] += s * step.x + c * step.y;
      particles_.yaw[i] = geometry::WrapToPi(particles_.yaw[i] + step.yaw);
    }
  }

  void Weigh(const Beams& beams, double range_max) {
    if (!table_ || table_range_ != range_max) {
      table_range_ = range_max;
      table_ = std::make_shared<const std::vector<float>>(map_->field.LogLikelihoods(
          params_.laser_z_hit, params_.laser_z_rand, params_.laser_sigma_hit, range_max));
    }
    std::vector<float> sums;
    SumOverBeams(particles_, beams, map_->field, *table_, &sums);
    const double count = static_cast<double>(beams.size());
    const double most = params_.independent_beams;
    const double counted = IsUndecided() ? std::min(most, kBeamsWhileUndecided) : most;
    const double power = std::min(1.0, counted / count);
    const double best = *std::max_element(sums.begin(), sums.end());
    double fit = 0.0, total = 0.0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
      double& weight = particles_.weight[i];
      fit += weight * std::exp(sums[i] / count);
      weight *= std::exp(power * (sums[i] - best));
      total += weight;
    }
    Normalise(total);
    // Scans fit badly while it is still looking for its place: that is no measure for later.
    const bool is_first = slow_ == 0.0 || summary_.best_spread > params_.lost_spread;
    slow_ = is_first ? fit : slow_ + params_.recovery_alpha_slow * (fit - slow_);
    fast_ = is_first ? fit : fast_ + params_.recovery_alpha_fast * (fit - fast_);
  }

  void Normalise(double total) {
    const double even = 1.0 / static_cast<double>(particles_.size());
    for (double& weight : particles_.weight) weight = total > 0.0 ? weight / total : even;
  }

  void Draw() {
    num_since_drawn_ = 0;
    // Of several places none may die out by chance.
    const int least = IsUndecided() ? params_.max_particles : params_.min_particles;
    const KldParams kld{params_.kld_err, params_.kld_z, least, params_.max_particles};
    particles_ = Resample(particles_, kld, &rng_);
    const double share = slow_ > 0.0 ? std::max(0.0, 1.0 - fast_ / slow_) : 0.0;
    if (share == 0.0 || map_->free_cells.empty()) return;
    for (std::size_t i = 0; i < particles_.size(); ++i) {
      if (!rng_.Bernoulli(share)) continue;
      const Pose2 X_MB = map_->AnyFreePose(&rng_);
      particles_.x[i] = X_MB.x;
      particles_.y[i] = X_MB.y;
      particles_.yaw[i] = X_MB.yaw;
    }
  }

  void JudgeExplained(const Beams& beams) {
    const Pose2 X_MB = CorrectedOdometry() * seen_->X_OB;
    const double c = std::cos(X_MB.yaw), s = std::sin(X_MB.yaw);
    int count = 0;
    for (std::size_t k = 0; k < beams.size(); ++k) {
      const double x = X_MB.x + c * beams.x[k] - s * beams.y[k];
      const double y = X_MB.y + s * beams.x[k] + c * beams.y[k];
      count += map_->field.DistanceAt(x, y) <= params_.explained_distance;
    }
    explained_ = static_cast<double>(count) / static_cast<double>(beams.size());
    const double mean = explained_mean_.value_or(explained_);
    explained_mean_ = mean + kExplainedRate * (explained_ - mean);
  }

  bool IsExplained() const { return explained_mean_.value_or(1.0) >= params_.lost_explained; }

  LocalisationStatus StatusAt(double time) const {
    if (!last_scan_ || time - *last_scan_ > params_.scan_timeout) {
      return LocalisationStatus::kNoScan;
    }
    if (summary_.best_spread > params_.lost_spread || summary_.num_clusters == 0) {
      return LocalisationStatus::kSpread;
    }
    if (!IsExplained()) return LocalisationStatus::kUnexplained;
    return summary_.num_clusters > 1 ? LocalisationStatus::kAmbiguous : LocalisationStatus::kGood;
  }

  std::shared_ptr<const KnownMap> map_;
  MonteCarloParams params_;
  robot::OdometryJumps jumps_;
  BeamParams beam_params_;
  base::Rng rng_;
  Particles particles_;
  BeliefSummary summary_;  // as of the last scan that was used
  double effective_size_{0.0};
  std::optional<OdometryAnchor> seen_;  // odometry, the newest
  std::optional<OdometryAnchor> used_;  // odometry at which the particles are
  std::optional<double> last_scan_;
  bool is_forced_{true};
  int num_since_drawn_{0};
  double slow_{0.0}, fast_{0.0};  // how well scans fit; 0: none came
  double explained_{0.0};
  std::optional<double> explained_mean_;
  std::optional<double> unexplained_since_;  // [s]
  int num_searches_{0};
  std::shared_ptr<const std::vector<float>> table_;
  double table_range_{0.0};
};

MonteCarloLocalisation::MonteCarloLocalisation(const world::OccupancyGrid& map,
                                               const MonteCarloParams& params, base::Rng rng)
    : belief_(std::make_unique<Belief>(map, params, rng)) {}
MonteCarloLocalisation::MonteCarloLocalisation(const MonteCarloLocalisation& other)
    : belief_(std::make_unique<Belief>(*other.belief_)) {}
MonteCarloLocalisation& MonteCarloLocalisation::operator=(const MonteCarloLocalisation& other) {
  *belief_ = Belief(*other.belief_);
  return *this;
}
MonteCarloLocalisation::MonteCarloLocalisation(MonteCarloLocalisation&&) noexcept = default;
MonteCarloLocalisation& MonteCarloLocalisation::operator=(MonteCarloLocalisation&&) noexcept =
    default;
MonteCarloLocalisation::~MonteCarloLocalisation() = default;

void MonteCarloLocalisation::SetPose(const Pose2& X_MB, const Eigen::Matrix3d& covariance) {
  belief_->SetPose(X_MB, covariance);
}

void MonteCarloLocalisation::GlobalLocalisation() { belief_->GlobalLocalisation(); }

void MonteCarloLocalisation::UseNextScan() { belief_->UseNextScan(); }

void MonteCarloLocalisation::Reseed(base::Rng rng) { belief_->Reseed(std::move(rng)); }

bool MonteCarloLocalisation::WouldUse(const Pose2& X_OB) const { return belief_->WouldUse(X_OB); }

ScanOutcome MonteCarloLocalisation::Update(double time, const Pose2& X_OB,
                                           const robot::ScanReading& scan, const Pose2& X_BL) {
  return belief_->Update(time, X_OB, scan, X_BL);
}

PoseEstimate MonteCarloLocalisation::Estimate(double time) const { return belief_->Estimate(time); }

Pose2 MonteCarloLocalisation::CorrectedOdometry() const { return belief_->CorrectedOdometry(); }

std::vector<Pose2> MonteCarloLocalisation::ParticlePoses() const {
  return belief_->ParticlePoses();
}

}  // namespace hires::localisation
