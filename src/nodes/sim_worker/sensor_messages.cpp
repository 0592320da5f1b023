#include "nodes/sim_worker/sensor_messages.h"

#include <boost/predef/other/endian.h>
#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "hires/base/check.h"
#include "hires/ros/values/geometry_messages.h"

namespace hires_ros {
namespace {

using hires::perception::PointCloud;

constexpr bool kIsBigEndian = BOOST_ENDIAN_BIG_BYTE != 0;

void AddField(const std::string& name, sensor_msgs::PointCloud2* msg) {
  sensor_msgs::PointField field;
  field.name = name;
  field.offset = msg->point_step;
  field.datatype = sensor_msgs::PointField::FLOAT32;
  field.count = 1;
  msg->fields.push_back(field);
  msg->point_step += sizeof(float);
}

/// Everything but the points, for which there is room.
sensor_msgs::PointCloud2 EmptyMsg(const PointCloud& cloud, const std::vector<const char*>& fields) {
  sensor_msgs::PointCloud2 msg;
  msg.width = static_cast<std::uint32_t>(cloud.width);
  msg.height = static_cast<std::uint32_t>(cloud.height);
  for (const char* name : fields) AddField(name, &msg);
  msg.row_step = msg.width * msg.point_step;
  msg.is_bigendian = static_cast<std::uint8_t>(kIsBigEndian);
  msg.is_dense = static_cast<std::uint8_t>(
      std::all_of(cloud.points.begin(), cloud.points.end(), hires::perception::IsMeasured));
  msg.data.resize(cloud.points.size() * msg.point_step);
  return msg;
}

sensor_msgs::Image EmptyMsg(int width, int height, const char* encoding, std::size_t pixel_size) {
  sensor_msgs::Image msg;
  msg.width = static_cast<std::uint32_t>(width);
  msg.height = static_cast<std::uint32_t>(height);
  msg.encoding = encoding;
  msg.is_bigendian = static_cast<std::uint8_t>(kIsBigEndian);
  msg.step = static_cast<std::uint32_t>(width * pixel_size);
  msg.data.resize(static_cast<std::size_t>(msg.step) * msg.height);
  return msg;
}

std::uint16_t ToMillimetres(float metres) {
  constexpr float kMost = std::numeric_limits<std::uint16_t>::max();
  const float millimetres = 1000.0F * metres;
  const bool is_measured = std::isfinite(metres) && millimetres > 0.0F && millimetres <= kMost;
  return is_measured ? static_cast<std::uint16_t>(std::lround(millimetres)) : 0;
}

}  // namespace

sensor_msgs::PointCloud2 ToMsg(const PointCloud& cloud) {
  sensor_msgs::PointCloud2 msg = EmptyMsg(cloud, {"x", "y", "z"});
  std::uint8_t* to = msg.data.data();
  for (const Eigen::Vector3f& p : cloud.points) {
    std::memcpy(to, p.data(), 3 * sizeof(float));
    to += msg.point_step;
  }
  return msg;
}

sensor_msgs::PointCloud2 ToMsg(const PointCloud& cloud, const hires::perception::Picture& colours) {
  HIRES_CHECK(cloud.width == colours.width && cloud.height == colours.height,
              "each point has its pixel");
  sensor_msgs::PointCloud2 msg = EmptyMsg(cloud, {"x", "y", "z", "rgb"});
  std::uint8_t* to = msg.data.data();
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const auto& [red, green, blue] = colours.pixels[i];
    const std::uint32_t rgb =
        static_cast<std::uint32_t>(red) << 16U | static_cast<std::uint32_t>(green) << 8U | blue;
    std::memcpy(to, cloud.points[i].data(), 3 * sizeof(float));
    std::memcpy(to + 3 * sizeof(float), &rgb, sizeof(rgb));
    to += msg.point_step;
  }
  return msg;
}

sensor_msgs::Image DepthToMsg(const PointCloud& cloud) {
  sensor_msgs::Image msg =
      EmptyMsg(cloud.width, cloud.height, sensor_msgs::image_encodings::TYPE_16UC1.c_str(),
               sizeof(std::uint16_t));
  std::uint8_t* to = msg.data.data();
  for (const Eigen::Vector3f& p : cloud.points) {
    const std::uint16_t depth = ToMillimetres(p.z());
    std::memcpy(to, &depth, sizeof(depth));
    to += sizeof(depth);
  }
  return msg;
}

sensor_msgs::Image ToMsg(const hires::perception::Picture& picture) {
  sensor_msgs::Image msg =
      EmptyMsg(picture.width, picture.height, sensor_msgs::image_encodings::RGB8.c_str(), 3);
  std::uint8_t* to = msg.data.data();
  for (const hires::perception::Colour& colour : picture.pixels) {
    to = std::copy(colour.begin(), colour.end(), to);
  }
  return msg;
}

sensor_msgs::Image ToMsg(const hires::perception::HeatPicture& heat) {
  sensor_msgs::Image msg = EmptyMsg(
      heat.width, heat.height, sensor_msgs::image_encodings::MONO16.c_str(), sizeof(std::uint16_t));
  std::memcpy(msg.data.data(), heat.centikelvin.data(), msg.data.size());
  return msg;
}

sensor_msgs::CameraInfo ToMsg(const hires::perception::PinholeCamera& camera) {
  sensor_msgs::CameraInfo msg;
  msg.width = static_cast<std::uint32_t>(camera.width);
  msg.height = static_cast<std::uint32_t>(camera.height);
  msg.distortion_model = "plumb_bob";
  msg.D.assign(5, 0.0);
  const double f = camera.focal_length;
  const double cx = 0.5 * (camera.width - 1), cy = 0.5 * (camera.height - 1);
  msg.K = {f, 0.0, cx, 0.0, f, cy, 0.0, 0.0, 1.0};
  msg.R = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  msg.P = {f, 0.0, cx, 0.0, 0.0, f, cy, 0.0, 0.0, 0.0, 1.0, 0.0};
  return msg;
}

sensor_msgs::LaserScan ToMsg(const hires::simulation::LaserParams& laser,
                             const std::vector<double>& ranges, double period) {
  sensor_msgs::LaserScan msg;
  msg.angle_min = static_cast<float>(laser.angle_min);
  msg.angle_max = static_cast<float>(laser.angle_max);
  msg.angle_increment =
      static_cast<float>((laser.angle_max - laser.angle_min) / (laser.num_beams - 1));
  msg.scan_time = static_cast<float>(period);
  msg.range_min = static_cast<float>(laser.range_min);
  msg.range_max = static_cast<float>(laser.range_max);
  msg.ranges.assign(ranges.begin(), ranges.end());
  return msg;
}

sensor_msgs::Imu ToMsg(const hires::robot::ImuReading& reading, const Eigen::Quaterniond& R_BI) {
  const Eigen::Quaterniond R_WB(Eigen::AngleAxisd(reading.yaw, Eigen::Vector3d::UnitZ()));
  const Eigen::Vector3d turning_I = R_BI.inverse() * Eigen::Vector3d(0.0, 0.0, reading.yaw_rate);
  sensor_msgs::Imu msg;
  msg.orientation = ToMsg(hires::geometry::Pose3{Eigen::Vector3d::Zero(), R_WB * R_BI}).orientation;
  msg.angular_velocity.x = turning_I.x();
  msg.angular_velocity.y = turning_I.y();
  msg.angular_velocity.z = turning_I.z();
  msg.linear_acceleration_covariance[0] = -1.0;  // not measured
  return msg;
}

}  // namespace hires_ros
