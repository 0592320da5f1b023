#include "nodes/heat_reader/heat_messages.h"

#include <fmt/format.h>
#include <sensor_msgs/image_encodings.h>

#include <cmath>

#include "hires/base/error.h"

namespace hires_ros {
namespace {

using hires::base::ConfigError;
namespace encodings = sensor_msgs::image_encodings;

constexpr double kTolerance = 0.02;  // of focal length and width
constexpr std::uint32_t kLargest = 16384;

}  // namespace

hires::perception::HeatPicture HeatFromMsg(const sensor_msgs::Image& msg) {
  if (msg.encoding != encodings::MONO16 && msg.encoding != encodings::TYPE_16UC1) {
    throw ConfigError(fmt::format(
        "encoding is '{}', wanted mono16 or 16UC1 with centikelvin in each pixel", msg.encoding));
  }
  if (msg.is_bigendian) throw ConfigError("the picture is big-endian, wanted little-endian");
  if (msg.width == 0 || msg.height == 0 || msg.width > kLargest || msg.height > kLargest) {
    throw ConfigError(fmt::format("the picture has {} x {} pixels, wanted 1 to {} each way",
                                  msg.width, msg.height, kLargest));
  }
  const std::size_t row = sizeof(std::uint16_t) * msg.width;
  if (msg.step < row || msg.data.size() < std::size_t{msg.step} * msg.height) {
    throw ConfigError(fmt::format(
        "{} bytes of {} x {} pixels, step {}: wanted step to hold 2 bytes a pixel, data to hold "
        "height * step",
        msg.data.size(), msg.width, msg.height, msg.step));
  }
  hires::perception::HeatPicture heat{
      static_cast<int>(msg.width), static_cast<int>(msg.height), {}};
  heat.centikelvin.reserve(std::size_t{msg.width} * msg.height);
  for (std::uint32_t y = 0; y < msg.height; ++y) {
    const std::uint8_t* byte = msg.data.data() + std::size_t{y} * msg.step;
    for (std::uint32_t x = 0; x < msg.width; ++x, byte += 2) {
      heat.centikelvin.push_back(static_cast<std::uint16_t>(byte[0] | byte[1] << 8));
    }
  }
  return heat;
}

hires::perception::PinholeCamera CameraFromMsg(const sensor_msgs::CameraInfo& msg) {
  const double fx = msg.P[0], fy = msg.P[5], cx = msg.P[2], cy = msg.P[6];
  if (msg.width == 0 || msg.height == 0 || !(fx > 0.0) || !(fy > 0.0) || !std::isfinite(fx)) {
    throw ConfigError(
        fmt::format("camera_info says {} x {} pixels, focal lengths {:g} and {:g} in P, wanted "
                    "more than 0 of each; calibrate the camera",
                    msg.width, msg.height, fx, fy));
  }
  const bool is_square = std::abs(fx - fy) <= kTolerance * fx;
  const bool is_centred = std::abs(cx - 0.5 * (msg.width - 1.0)) <= kTolerance * msg.width &&
                          std::abs(cy - 0.5 * (msg.height - 1.0)) <= kTolerance * msg.width;
  if (!is_square || !is_centred) {
    throw ConfigError(fmt::format(
        "camera_info's P has focal lengths {:g} and {:g} and its axis at {:g}, {:g} of {} x {} "
        "pixels, wanted square pixels and the axis in the middle, within 2 %",
        fx, fy, cx, cy, msg.width, msg.height));
  }
  return {{}, static_cast<int>(msg.width), static_cast<int>(msg.height), fx};
}

hires::ObjectTemperatures ToMsg(const hires::perception::HeatReading& reading,
                                const std_msgs::Header& header) {
  constexpr double kZero = hires::perception::kZeroCelsius;
  hires::ObjectTemperatures msg;
  msg.header = header;
  for (const hires::perception::ObjectHeat& object : reading.objects) {
    hires::ObjectTemperature& told = msg.objects.emplace_back();
    told.object = object.name;
    told.temperature = static_cast<float>(object.temperature - kZero);
    told.hottest = static_cast<float>(object.hottest - kZero);
    told.num_pixels = static_cast<std::uint32_t>(object.num_pixels);
    told.mixed_with = object.mixed_with;
  }
  return msg;
}

}  // namespace hires_ros
