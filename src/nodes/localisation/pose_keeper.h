#pragma once

#include <ros/node_handle.h>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "hires/base/thread_pool.h"
#include "hires/geometry/pose.h"

namespace hires_ros {

/// Where a robot was in the map, and where its odometry had it then.
struct KeptPlace {
  hires::geometry::Pose2 X_MB;
  Eigen::Vector3d variance{Eigen::Vector3d::Zero()};  ///< [m^2, m^2, rad^2] of x, y, yaw
  hires::geometry::Pose2 X_OB;
  double time{0.0};  ///< [s] on the robot's clock
};

/// The private parameters that PoseKeeper writes, beside AMCL's own.
std::vector<std::string> KeptKeys();

/// What an earlier process of this node's name kept: of the private parameters; nothing where one
/// of KeptKeys() or of AMCL's is missing.
/// @throws hires::base::ConfigError for one that is no number.
std::optional<KeptPlace> ReadKeptPlace();

/// Where the robot is at `time` [s], by what its odometry drove since; nothing where that is not
/// known: the clock or the odometry began again.
/// @param max_speed  [m/s] of a base: odometry that went farther was reset.
std::optional<hires::geometry::Pose2> PlaceNow(const KeptPlace& kept,
                                               const hires::geometry::Pose2& X_OB, double time,
                                               double max_speed);

/// Keeps where the robot is in private parameters, as AMCL does (initial_pose_x, ...), so that a
/// node that dies goes on from there when it is started again. A master that does not answer holds
/// up nobody.
class PoseKeeper {
 public:
  /// @param node  handle of the private names.
  explicit PoseKeeper(const ros::NodeHandle& node) : node_(node) {}

  /// Keeps it, unless something was kept less than 2 s of the robot's clock ago.
  void Note(const KeptPlace& place);

 private:
  void Write(const KeptPlace& place) const;

  ros::NodeHandle node_;
  std::optional<double> kept_;      // [s] of the last place
  hires::base::ThreadPool thread_;  // last: it uses the others
};

}  // namespace hires_ros
