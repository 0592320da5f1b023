#include "perception/support/tabletop_scenes.h"

#include <png.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>

namespace hires::test_support {
namespace {

constexpr int kWidth = 640, kHeight = 480;
constexpr double kFocalLength = 525.0;  // [pixels], as are the next two
constexpr double kMiddleColumn = 319.5, kMiddleRow = 239.5;
constexpr double kDepthUnit = 1e-4;  // [m]

template <typename Value>
std::vector<Value> ReadGrey(const std::string& path, png_uint_32 format) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  const std::unique_ptr<png_image, decltype(&png_image_free)> freed(&png, png_image_free);
  std::vector<Value> pixels(std::size_t{kWidth} * kHeight);
  if (!png_image_begin_read_from_file(&png, path.c_str()) || png.width != kWidth ||
      png.height != kHeight) {
    throw std::runtime_error(path + ": is no picture of 640 x 480; " + png.message);
  }
  png.format = format;
  if (!png_image_finish_read(&png, nullptr, pixels.data(), 0, nullptr))
    throw std::runtime_error(path + ": " + png.message);
  return pixels;
}

}  // namespace

TabletopScene ReadTabletopScene(const std::string& stem) {
  const auto depth = ReadGrey<std::uint16_t>(stem + "_depth.png", PNG_FORMAT_LINEAR_Y);
  const auto labels = ReadGrey<std::uint8_t>(stem + "_label.png", PNG_FORMAT_GRAY);
  TabletopScene scene;
  scene.cloud.width = kWidth;
  scene.cloud.height = kHeight;
  scene.truth.assign(labels.begin(), labels.end());
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (depth[i] == 0) scene.truth[i] = 0;
    const double z =
        depth[i] > 0 ? depth[i] * kDepthUnit : std::numeric_limits<double>::quiet_NaN();
    const double column = static_cast<double>(i % kWidth), row = static_cast<double>(i / kWidth);
    scene.cloud.points.push_back(Eigen::Vector3d((column - kMiddleColumn) * z / kFocalLength,
                                                 (row - kMiddleRow) * z / kFocalLength, z)
                                     .cast<float>());
  }
  return scene;
}

}  // namespace hires::test_support
