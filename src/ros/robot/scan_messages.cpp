#include "hires/ros/robot/scan_messages.h"

#include <fmt/format.h>

#include <boost/make_shared.hpp>
#include <cmath>

#include "hires/base/error.h"
#include "hires/robot/echoes.h"

namespace hires_ros {

hires::robot::ScanReading ReadingOf(const sensor_msgs::LaserScan& msg) {
  hires::robot::ScanReading reading{msg.angle_min, msg.angle_increment, msg.range_min, msg.ranges,
                                    msg.range_max};
  const double span = static_cast<double>(msg.angle_max) - msg.angle_min;
  const bool is_told_by_span =
      std::isfinite(span) && span != 0.0 && msg.angle_max != 0.0F && msg.ranges.size() > 1;
  if (msg.angle_increment == 0.0F && is_told_by_span)
    reading.angle_increment = span / static_cast<double>(msg.ranges.size() - 1);
  return reading;
}

sensor_msgs::LaserScan NearestEchoesOf(const sensor_msgs::MultiEchoLaserScan& msg) {
  sensor_msgs::LaserScan scan;
  scan.header = msg.header;
  scan.angle_min = msg.angle_min;
  scan.angle_max = msg.angle_max;
  scan.angle_increment = msg.angle_increment;
  scan.time_increment = msg.time_increment;
  scan.scan_time = msg.scan_time;
  scan.range_min = msg.range_min;
  scan.range_max = msg.range_max;
  scan.ranges.reserve(msg.ranges.size());
  for (const sensor_msgs::LaserEcho& beam : msg.ranges)
    scan.ranges.push_back(hires::robot::NearestEcho(beam.echoes, msg.range_min));
  return scan;
}

sensor_msgs::LaserScanConstPtr LaserScanOf(const topic_tools::ShapeShifter& msg) {
  try {
    if (msg.getDataType() == "sensor_msgs/MultiEchoLaserScan") {
      const auto scan = msg.instantiate<sensor_msgs::MultiEchoLaserScan>();
      return boost::make_shared<sensor_msgs::LaserScan>(NearestEchoesOf(*scan));
    }
    return msg.instantiate<sensor_msgs::LaserScan>();
  } catch (const topic_tools::ShapeShifterException&) {
    throw hires::base::ConfigError(
        fmt::format("its type is {}, wanted sensor_msgs/LaserScan or MultiEchoLaserScan, of this "
                    "version; name the topic of the base's laser as base_scan in the names file",
                    msg.getDataType()));
  } catch (const ros::serialization::StreamOverrunException&) {
    throw hires::base::ConfigError(
        fmt::format("a message of type {} ends too early", msg.getDataType()));
  }
}

}  // namespace hires_ros
