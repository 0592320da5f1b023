#pragma once

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/LaserScan.h>
#include <sensor_msgs/PointCloud2.h>

#include <vector>

#include "hires/perception/heat_picture.h"
#include "hires/perception/picture.h"
#include "hires/perception/pinhole_camera.h"
#include "hires/perception/point_cloud.h"
#include "hires/robot/readings.h"
#include "hires/simulation/laser_scanner.h"

/// Clouds, pictures, scans and inertial readings as messages. Headers are left to those who send
/// them: pictures and clouds of a camera are in its optical frame.
namespace hires_ros {

/// x, y, z [m] as float32; NaN, not measured, stays NaN.
sensor_msgs::PointCloud2 ToMsg(const hires::perception::PointCloud& cloud);
/// With `rgb` beside each point: a float32 whose bits are 0x00rrggbb, as PCL has it.
/// @pre an organised cloud and a picture of one size.
sensor_msgs::PointCloud2 ToMsg(const hires::perception::PointCloud& cloud,
                               const hires::perception::Picture& colours);

/// Depths along the camera's axis: 16UC1 in millimetres, 0: not measured (REP 118).
sensor_msgs::Image DepthToMsg(const hires::perception::PointCloud& cloud);
sensor_msgs::Image ToMsg(const hires::perception::Picture& picture);   ///< rgb8
sensor_msgs::Image ToMsg(const hires::perception::HeatPicture& heat);  ///< mono16, centikelvin

/// Without distortion. As in ROS the middle of the top left pixel is (0, 0): the optical axis goes
/// through (width - 1) / 2, (height - 1) / 2.
sensor_msgs::CameraInfo ToMsg(const hires::perception::PinholeCamera& camera);

/// @param ranges  [m] of each beam.  @param period  [s] from one scan to the next.
sensor_msgs::LaserScan ToMsg(const hires::simulation::LaserParams& laser,
                             const std::vector<double>& ranges, double period);

/// Of a unit mounted so in the base; it tells no accelerations.
sensor_msgs::Imu ToMsg(const hires::robot::ImuReading& reading, const Eigen::Quaterniond& R_BI);

}  // namespace hires_ros
