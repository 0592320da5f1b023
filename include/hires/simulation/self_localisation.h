#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/geometry/pose.h"
#include "hires/localisation/monte_carlo.h"
#include "hires/localisation/odometry_filter.h"
#include "hires/robot/readings.h"
#include "hires/simulation/laser_params.h"
#include "hires/simulation/scene.h"
#include "hires/world/occupancy_grid.h"
#include "hires/world/world.h"

namespace hires::simulation {

/// Steered casters with two wheels each, and how what their encoders tell differs from how the base
/// moves.
struct CasterParams {
  std::vector<Eigen::Vector2d> casters_B;  ///< [m] axes about which they steer; three or more
  double track{0.098};                     ///< [m] between the wheels of a caster
  double wear{0.0};          ///< sd of the share by which all wheels are larger or smaller
  double radius_error{0.0};  ///< sd of the share by which each one is, beside that
  double slip{0.0};          ///< [m / sqrt(m)] sd of what a wheel slips on its way
  double scrub{0.0};         ///< [m / sqrt(rad)] sd of the same while its caster steers
  double resolution{0.0};    ///< [m] on the floor from one count of the encoder to the next; 0: any
};

/// Odometry of such a base: least squares over the wheels, as a PR2's has it. A base that is moved
/// without its wheels, or faster than they can turn, is none of its business.
class WheelOdometry {
 public:
  WheelOdometry(const CasterParams& params, base::Rng rng);

  /// The base moved by X_AB, seen from where it was; so little that it went straight on an arc.
  void Roll(const geometry::Pose2& X_AB);

  const geometry::Pose2& X_OB() const { return X_OB_; }  ///< from where it began

 private:
  struct Wheel {
    double growth;       // told way by true one
    double way{0.0};     // [m] that the wheel turned by
    double counts{0.0};  // [m] of those that were told
  };
  struct Caster {
    Eigen::Vector2d at_B;
    double angle{0.0};  // [rad] of its wheels in the base
    std::array<Wheel, 2> wheels;
  };
  double Told(Wheel* wheel, double rolled, double steered);

  CasterParams params_;
  base::Rng rng_;
  std::vector<Caster> casters_;
  geometry::Pose2 X_OB_;
};

/// How an inertial unit errs that integrates its rate to a heading.
struct GyroParams {
  double walk{0.0};       ///< [rad / sqrt(s)] sd by which the heading strays, by the rate's noise
  double bias{0.0};       ///< [rad/s] sd of the rate's error at first
  double bias_walk{0.0};  ///< [rad/s / sqrt(s)] sd by which that wanders
};

/// A round part of the floor on which wheels spin: they tell of more way than there was.
struct WetPatch {
  Eigen::Vector2d at_M{Eigen::Vector2d::Zero()};  ///< [m]
  double radius{0.0};                             ///< [m]
  double spin{0.0};                               ///< told way by true one, less 1: sd, drawn anew
                                                  ///< whenever the base comes onto it
};

/// What a robot needs that finds its place by itself.
struct SelfLocalisationParams {
  localisation::MonteCarloParams filter;
  localisation::OdometryFilterParams odometry;
  CasterParams casters;
  GyroParams gyro;
  LaserParams laser;           ///< of the base; as many beams of it are played as the filter uses
  double scan_period{1.0};     ///< [s] after which it scans even where it stands
  double start_sd{0.0};        ///< [m] by which x and y of the start are off that it is told ...
  double start_sd_yaw{0.0};    ///< [rad] ... and its heading
  double map_resolution{0.0};  ///< [m]

  /// Places of the map: the robot was carried, and takes itself to be at one of these that is at
  /// least kCarriedAway from where it starts. None: near its start, as the deviations above say.
  std::vector<geometry::Pose2> mistaken_for;
  std::vector<WetPatch> wet;
};

constexpr double kCarriedAway = 1.0;  ///< [m]

/// A file like config/self_localisation.yaml; the files that it names are found beside it.
/// @throws base::ConfigError naming file and key.
SelfLocalisationParams LoadSelfLocalisation(const std::string& path);

/// The map in which the robot looks for its place: a slice of the world in the laser's plane.
/// @param laser_height  [m] of the base's laser above the floor.
world::OccupancyGrid MapIn(const SelfLocalisationParams& params, const world::World& world,
                           double laser_height);

/// The same for all robots in one world: parameters, and a filter that knows the map. Constant.
class SelfLocalisation {
 public:
  /// @param world  as the map has it, in which the robot looks for its place.
  /// @param laser_height  [m] of the base's laser above the floor.
  /// @throws base::ConfigError where no map of it would tell a place.
  SelfLocalisation(const SelfLocalisationParams& params, const world::World& world,
                   double laser_height);

  const SelfLocalisationParams& params() const { return params_; }
  const localisation::MonteCarloLocalisation& filter() const { return filter_; }

 private:
  SelfLocalisationParams params_;
  localisation::MonteCarloLocalisation filter_;  // begun nowhere yet
};

/// The same scene, in which the robot finds its place by itself.
/// @param mapped  as the map has the world; it may be another one than it is really.
/// @throws base::ConfigError for a robot without a base laser or an upper body.
std::shared_ptr<const Scene> FindingItsPlace(Scene scene, const SelfLocalisationParams& params,
                                             const world::World& mapped);

/// What wheels and inertial unit of a base tell of its motion. A value: a copy goes on like the
/// original.
class MotionSensors {
 public:
  /// The base stands at X_MB.
  MotionSensors(std::shared_ptr<const SelfLocalisationParams> params, const geometry::Pose2& X_MB,
                const base::Rng& rng);

  /// The base came to X_MB in `dt` [s], which is more than 0.
  void Drive(double dt, const geometry::Pose2& X_MB);
  /// The base was lifted to X_MB: wheels and unit were not turned by it.
  void PutAt(const geometry::Pose2& X_MB) { X_MBtrue_ = X_MB; }

  /// Base in the frame in which the wheels began to count, and its velocity in the last Drive.
  const robot::OdometryReading& odometry() const { return odometry_; }
  const robot::ImuReading& inertia() const { return inertia_; }
  const geometry::Pose2& X_MBtrue() const { return X_MBtrue_; }  ///< of the last Drive or PutAt

 private:
  geometry::Pose2 Spun(const geometry::Pose2& X_AB);

  std::shared_ptr<const SelfLocalisationParams> params_;
  base::Rng gyro_rng_;
  WheelOdometry wheels_;
  geometry::Pose2 X_MBtrue_;
  double bias_;  // [rad/s] of the unit
  robot::OdometryReading odometry_;
  robot::ImuReading inertia_;
  base::Rng floor_rng_;
  double spin_{0.0};  // of the wet patch that it is on
  bool is_on_wet_{false};
};

/// Where a robot that stands at X_MB is told that it starts: off as start_sd says, or, where it was
/// carried, at another place.
geometry::Pose2 BelievedStart(const SelfLocalisationParams& params, const geometry::Pose2& X_MB,
                              const base::Rng& rng);
/// How sure of that it is told to be: [m^2, m^2, rad^2] of x, y, yaw.
Eigen::Matrix3d StartCovariance(const SelfLocalisationParams& params);

/// Where a robot believes that it is, by wheels, inertial unit and laser: MotionSensors,
/// OdometryFilter and MonteCarloLocalisation, one after the other. A value: a copy goes on like the
/// original.
class SelfLocaliser {
 public:
  /// The base stands at X_MB; the robot is told so, but not exactly.
  SelfLocaliser(std::shared_ptr<const SelfLocalisation> common, const geometry::Pose2& X_MB,
                const base::Rng& rng);

  /// The base is at X_MB at `time` [s]; earlier than before: nothing is new.
  void Drive(double time, const geometry::Pose2& X_MB);
  /// The base was lifted to X_MB and stands there at `time` [s], of a clock that may have begun
  /// again; wheels and unit were not turned by it.
  void PutAt(double time, const geometry::Pose2& X_MB);

  bool wants_scan() const;  ///< now
  base::Rng* scan_rng() { return &scan_rng_; }
  /// @param X_BL  laser in the base
  void Hear(const robot::ScanReading& scan, const geometry::Pose2& X_BL);

  const geometry::Pose2& X_OB() const { return X_OB_; }  ///< odometry, with the unit's heading
  const geometry::Twist2& V_B() const { return motion_.odometry().V_B; }  ///< in the last Drive
  geometry::Pose2 X_MB() const;                                           ///< believed
  localisation::PoseEstimate Estimate() const;                            ///< now
  /// Of the last Drive or PutAt.
  const geometry::Pose2& X_MBtrue() const { return motion_.X_MBtrue(); }
  const SelfLocalisationParams& params() const { return common_->params(); }

 private:
  double now() const { return time_ + offset_; }

  std::shared_ptr<const SelfLocalisation> common_;
  base::Rng scan_rng_;
  MotionSensors motion_;
  localisation::OdometryFilter odometry_;
  localisation::MonteCarloLocalisation filter_;
  double time_{0.0}, offset_{0.0};  // [s] of the simulator's clock, and what came before it
  geometry::Pose2 X_OB_;
  std::optional<double> scanned_;  // [s] now()
};

}  // namespace hires::simulation
