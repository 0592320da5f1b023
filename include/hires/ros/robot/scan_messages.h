#pragma once

#include <sensor_msgs/LaserScan.h>
#include <sensor_msgs/MultiEchoLaserScan.h>
#include <topic_tools/shape_shifter.h>

#include "hires/robot/readings.h"

namespace hires_ros {

/// Where a driver leaves angle_increment 0, it is what angle_max tells, unless that is left 0,
/// too.
hires::robot::ScanReading ReadingOf(const sensor_msgs::LaserScan& msg);

/// With the nearest echo of each beam.
sensor_msgs::LaserScan NearestEchoesOf(const sensor_msgs::MultiEchoLaserScan& msg);

/// A scan of whichever type its driver tells: sensor_msgs/LaserScan, or MultiEchoLaserScan, of
/// which the nearest echoes count.  @throws hires::base::ConfigError for another type, or version.
sensor_msgs::LaserScanConstPtr LaserScanOf(const topic_tools::ShapeShifter& msg);

}  // namespace hires_ros
