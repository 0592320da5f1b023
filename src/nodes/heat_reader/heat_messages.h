#pragma once

#include <hires/ObjectTemperatures.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "hires/perception/warm_objects.h"

namespace hires_ros {

/// A picture in mono16 or 16UC1, centikelvin, little-endian.
/// @throws hires::base::ConfigError naming what is wrong.
hires::perception::HeatPicture HeatFromMsg(const sensor_msgs::Image& msg);

/// The camera by its projection matrix P, with X_MC unset: a rectified one, or one that has no
/// distortion; square pixels, the optical axis near the picture's middle (both within 2 %).
/// @throws hires::base::ConfigError naming what is wrong.
hires::perception::PinholeCamera CameraFromMsg(const sensor_msgs::CameraInfo& msg);

/// @param header  of the picture.
hires::ObjectTemperatures ToMsg(const hires::perception::HeatReading& reading,
                                const std_msgs::Header& header);

}  // namespace hires_ros
