#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "hires/base/rng.h"
#include "hires/geometry/pose.h"
#include "hires/simulation/self_localisation.h"
#include "hires/world/world.h"

namespace hires::simulation {

/// How the place errs at which a robot takes itself to be, as was found of one that finds it by
/// itself (`hires_lab experiment localisation`): a first-order autoregression from one correction
/// by the laser to the next, and odometry that drifts between two. Errors are those of the believed
/// base in the true one: ahead [m], to the left [m], turned [rad].
struct PoseErrorParams {
  double update_distance{0.2};  ///< [m] of the odometry or ...
  double update_turn{0.5};      ///< ... [rad] after which the laser corrects, as the filter's
  Eigen::Matrix3d kept{Eigen::Matrix3d::Zero()};   ///< of an error by a correction
  Eigen::Matrix3d added{Eigen::Matrix3d::Zero()};  ///< covariance of what a correction adds
  Eigen::Matrix3d start{Eigen::Matrix3d::Zero()};  ///< covariance at first
  double stretch{0.0};   ///< sd of the share by which all ways are told too long, per robot
  double walk{0.0};      ///< [m / sqrt(m)] sd of odometry on its way, ahead and to the left
  double walk_yaw{0.0};  ///< [rad / sqrt(m)] likewise
};

/// A file like config/localisation_error.yaml.
struct PoseErrorFile {
  PoseErrorParams params;
  std::string hash;  ///< of what it was fitted to, PlaceHash
};

/// @throws base::ConfigError naming file and key; for matrices that are no covariances, and a
/// `kept` by which errors grow from correction to correction.
PoseErrorFile ReadPoseError(const std::string& path);
/// What ReadPoseError reads, without comments.
std::string ToYaml(const PoseErrorFile& file);

/// Of all that an error of the place depends on but the code: wheels, inertial unit, laser and both
/// filters as their files say, and the map in which they look for it.
/// @param self_localisation  path of a file like config/self_localisation.yaml.
/// @param laser_height  [m] of the base's laser above the floor.
std::string PlaceHash(const std::string& self_localisation, const world::World& world,
                      double laser_height);

/// Where a robot believes that it is whose error goes so. A value: a copy goes on like the
/// original.
class PoseErrorWalk {
 public:
  /// The base stands at X_MB.
  PoseErrorWalk(const PoseErrorParams& params, const geometry::Pose2& X_MB, base::Rng rng);
  /// The same with this error at first.
  PoseErrorWalk(const PoseErrorParams& params, const geometry::Pose2& X_MB,
                const geometry::Pose2& error, base::Rng rng);

  void Drive(const geometry::Pose2& X_MB);  ///< the base is there now

  geometry::Pose2 X_MBelieved() const { return X_MB_ * error_; }
  const geometry::Pose2& error() const { return error_; }  ///< the believed base in the true one
  const geometry::Pose2& X_OB() const { return X_OB_; }    ///< odometry, from where it began

 private:
  geometry::Pose2 Draw(const Eigen::Matrix3d& root);
  void Correct();

  PoseErrorParams params_;
  Eigen::Matrix3d added_root_;
  base::Rng rng_;
  double stretch_;
  geometry::Pose2 X_MB_, error_;
  geometry::Pose2 X_OB_, X_OBcorrected_;  // now, and at the last correction
};

}  // namespace hires::simulation
