#include "hires/ros/perception/cloud_messages.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <string>

#include "hires/base/error.h"

namespace hires_ros {
namespace {

/// [bytes] from the begin of a point.
std::uint32_t OffsetOf(const sensor_msgs::PointCloud2& msg, const std::string& name) {
  for (const sensor_msgs::PointField& field : msg.fields) {
    if (field.name != name) continue;
    if (field.datatype == sensor_msgs::PointField::FLOAT32 &&
        field.offset + sizeof(float) <= msg.point_step) {
      return field.offset;
    }
    throw hires::base::ConfigError(
        fmt::format("field '{}' has datatype {} at {} of {} bytes, wanted FLOAT32 ({}) within them",
                    name, field.datatype, field.offset, msg.point_step,
                    static_cast<int>(sensor_msgs::PointField::FLOAT32)));
  }
  throw hires::base::ConfigError(fmt::format("field '{}' is missing", name));
}

}  // namespace

hires::perception::PointCloud FromMsg(const sensor_msgs::PointCloud2& msg) {
  const std::array<std::uint32_t, 3> offsets{OffsetOf(msg, "x"), OffsetOf(msg, "y"),
                                             OffsetOf(msg, "z")};
  const std::uint64_t row = std::uint64_t{msg.width} * msg.point_step;
  if (msg.is_bigendian || msg.row_step < row ||
      msg.data.size() < std::uint64_t{msg.row_step} * msg.height) {
    throw hires::base::ConfigError(
        fmt::format("{} bytes of {} x {} points, point_step {}, row_step {}{}: wanted row_step to "
                    "hold width * point_step, data to hold height * row_step, little-endian",
                    msg.data.size(), msg.width, msg.height, msg.point_step, msg.row_step,
                    msg.is_bigendian ? ", big-endian" : ""));
  }
  hires::perception::PointCloud cloud{
      static_cast<int>(msg.width), static_cast<int>(msg.height), {}};
  cloud.points.resize(std::size_t{msg.width} * msg.height);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const std::uint8_t* point =
        msg.data.data() + i / msg.width * msg.row_step + i % msg.width * msg.point_step;
    for (int axis = 0; axis < 3; ++axis) {
      std::memcpy(&cloud.points[i][axis], point + offsets[axis], sizeof(float));
    }
  }
  return cloud;
}

}  // namespace hires_ros
