#pragma once

#include <geometry_msgs/PoseWithCovarianceStamped.h>

#include <Eigen/Core>

#include "hires/geometry/pose.h"

namespace hires_ros {

/// A planar pose and how sure it is.
struct UncertainPose {
  hires::geometry::Pose2 X_AB;
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};  ///< [m^2, m rad, rad^2] of x, y, yaw
};

/// Covariances of z, roll and pitch, which stay 0, are 0, too.
geometry_msgs::PoseWithCovarianceStamped ToMsg(const UncertainPose& pose,
                                               const std_msgs::Header& header);

/// z, roll and pitch are dropped.
/// @throws hires::base::ConfigError naming the field: what is not finite, and a quaternion that is
/// not of length 1. Whether the covariance is one is left to who uses it.
UncertainPose FromMsg(const geometry_msgs::PoseWithCovariance& msg);

/// @throws hires::base::ConfigError naming `where`: not finite, or not of length 1 within 1 %.
void RequireRotation(const geometry_msgs::Quaternion& rotation, const std::string& where);

}  // namespace hires_ros
