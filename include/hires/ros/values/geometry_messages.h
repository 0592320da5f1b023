#pragma once

#include <geometry_msgs/Pose.h>

#include "hires/geometry/pose.h"

/// Every float64 survives both ways bit for bit.
namespace hires_ros {

geometry_msgs::Pose ToMsg(const hires::geometry::Pose3& pose);
hires::geometry::Pose3 FromMsg(const geometry_msgs::Pose& pose);  ///< a quaternion of 0 is identity

}  // namespace hires_ros
