#pragma once

#include <sensor_msgs/PointCloud2.h>

#include "hires/perception/point_cloud.h"

namespace hires_ros {

/// Its fields x, y and z, of any layout in little-endian single precision; others are passed over.
/// @throws hires::base::ConfigError naming the field that is missing or of another type, or sizes
/// that do not fit.
hires::perception::PointCloud FromMsg(const sensor_msgs::PointCloud2& msg);

}  // namespace hires_ros
