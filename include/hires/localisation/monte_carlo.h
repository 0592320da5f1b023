#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/geometry/pose.h"
#include "hires/localisation/monte_carlo_params.h"
#include "hires/localisation/scan_outcome.h"
#include "hires/robot/readings.h"
#include "hires/world/occupancy_grid.h"

namespace hires::localisation {

enum class LocalisationStatus {
  kGood,
  kAmbiguous,    ///< several places fit
  kUnexplained,  ///< lost: the map explains too little of what the laser sees
  kSpread,       ///< lost: it may be anywhere within more than lost_spread
  kNoScan        ///< no scan that could be used came, or none for too long
};
std::string ToString(LocalisationStatus status);  ///< a word for files and people

/// Why a robot cannot be localised in a map, whatever it sees: it has no free cell, or no occupied
/// one. Empty: it may be.
std::string WhyUseless(const world::OccupancyGrid& map);

Eigen::AlignedBox2d ExtentOf(const world::OccupancyGrid& map);  ///< [m] of all cells, in the map
/// Why nobody can be told to be there; empty: it lies in the map, or is no number, as SetPose says.
std::string WhyOutside(const geometry::Pose2& X_MB, const Eigen::AlignedBox2d& extent);

/// What the filter believes.
struct PoseEstimate {
  geometry::Pose2 X_MB;  ///< mean of the heaviest cluster, moved on with the odometry since
  /// Symmetric, [m^2, m rad, rad^2] of x, y, yaw around that mean, of all particles in clusters
  /// that count: so it is large where two places fit. As of the last scan that was used; where
  /// scans come that cannot be used, it grows with the way as the odometry's model says. While the
  /// status is kUnexplained at least what lost_spread says, for then they know nothing.
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};
  int num_particles{0};
  double effective_size{0.0};  ///< 1 / sum of squared weights, after the last scan that was used
  int num_clusters{0};         ///< that hold at least 5 % of the weight
  double best_share{0.0};      ///< of the weight, that the heaviest cluster has
  double explained{0.0};       ///< share of the last scan's beams that end near an obstacle
  LocalisationStatus status{LocalisationStatus::kNoScan};
  int num_searches{0};  ///< so often it looked everywhere by itself
};

/// Where a robot is in a map, by its laser and its odometry: Monte Carlo localisation with a
/// likelihood field and an adaptive number of particles, as AMCL does it [Fox 2003, IJRR
/// 22:985-1003; Thrun, Burgard, Fox 2005, Probabilistic Robotics, 6.4 and 8.3].
///
/// A belief is a value: a copy goes on like the original, bit for bit, and shares the map with it.
/// Chance comes from the stream handed in; there is no clock, no thread and nothing global.
///
/// The weight of a particle is the product of its beams' likelihoods to the power of
/// min(1, independent_beams / beams), a proper likelihood that is tempered, and not AMCL's sum of
/// their cubes, which is none: so 30 and 60 beams make it equally sure, and how sure is one
/// parameter that can be measured. While it is undecided between places, or spread over more than
/// lost_spread, a scan counts as 2 beams at most and max_particles are kept, so that the true place
/// is not lost to a lucky one.
///
/// Random particles come back in when scans begin to fit worse than they used to (recovery_alpha);
/// "fit" is the geometric mean over the beams, so it does not depend on how many there are. Where
/// scans have been unexplained for relocate_after, it looks everywhere: most of its belief goes to
/// all free cells, a tenth stays where it was, so that a right place that was not recognised
/// (people all round, say) can win once more.
class MonteCarloLocalisation {
 public:
  /// Begins at params.initial_pose.  @throws base::ConfigError if the map suits no such parameters.
  /// @pre width and height >= 1, width * height cells, resolution > 0
  MonteCarloLocalisation(const world::OccupancyGrid& map, const MonteCarloParams& params,
                         base::Rng rng);
  MonteCarloLocalisation(const MonteCarloLocalisation& other);
  MonteCarloLocalisation& operator=(const MonteCarloLocalisation& other);
  MonteCarloLocalisation(MonteCarloLocalisation&&) noexcept;
  MonteCarloLocalisation& operator=(MonteCarloLocalisation&&) noexcept;
  ~MonteCarloLocalisation();

  /// Somebody says where the robot is now; the next scan is used even if it does not move.
  /// @param covariance  [m^2, m rad, rad^2] of x, y, yaw.
  /// @throws base::ConfigError where these are no numbers or the covariance is none.
  void SetPose(const geometry::Pose2& X_MB, const Eigen::Matrix3d& covariance);

  /// It may be on any free cell.  @throws base::ConfigError for a map without free cells.
  void GlobalLocalisation();

  /// The next scan is used even if the robot does not move.
  void UseNextScan();

  /// Chance comes from another stream from now on: a copy becomes a filter of its own.
  void Reseed(base::Rng rng);

  /// Whether it would use a scan of that moment: the base moved by update_min_d or update_min_a
  /// since the last one, or a scan is wanted anyway.
  bool WouldUse(const geometry::Pose2& X_OB) const;

  /// A scan, with where odometry and laser were at its time. Times [s] rise; one that goes back by
  /// robot::kClockReset or more, or odometry that jumps, leaves the belief alone and is where
  /// odometry goes on from; one that goes back by less is left out. One that
  /// cannot be used moves the belief on by the odometry alone.
  ScanOutcome Update(double time, const geometry::Pose2& X_OB, const robot::ScanReading& scan,
                     const geometry::Pose2& X_BL);

  /// @param time  [s] now; later than the last scan by more than scan_timeout is kNoScan.
  PoseEstimate Estimate(double time) const;

  /// Odometry's frame in the map: X_MO * X_OB is where the robot is until the next scan is used.
  geometry::Pose2 CorrectedOdometry() const;

  /// What it believes in, for displays.
  std::vector<geometry::Pose2> ParticlePoses() const;

 private:
  class Belief;
  std::unique_ptr<Belief> belief_;
};

}  // namespace hires::localisation
