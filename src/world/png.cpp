#include "world/png.h"

#include <fmt/format.h>
#include <png.h>

#include <memory>

#include "hires/base/error.h"

namespace hires::world {

bool IsPng(const std::string& bytes) { return bytes.compare(0, 4, "\x89PNG") == 0; }

GreyImage ParsePng(const std::string& bytes, const std::string& name) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  const std::unique_ptr<png_image, decltype(&png_image_free)> freed(&png, png_image_free);
  const auto fail = [&](const std::string& what) {
    throw base::ConfigError(fmt::format("{}: {}; save the image again", name, what));
  };
  if (!png_image_begin_read_from_memory(&png, bytes.data(), bytes.size())) fail(png.message);
  const std::size_t num_pixels = std::size_t{png.width} * png.height;
  if (num_pixels > std::size_t{kMaxPixels}) {
    throw base::ConfigError(fmt::format("{}: has {} pixels, at most {} are read; scale it down",
                                        name, num_pixels, kMaxPixels));
  }
  png.format = PNG_FORMAT_RGBA;
  std::vector<std::uint8_t> colours(PNG_IMAGE_SIZE(png));
  if (!png_image_finish_read(&png, nullptr, colours.data(), 0, nullptr)) fail(png.message);
  GreyImage image{static_cast<int>(png.width), static_cast<int>(png.height), {}};
  image.pixels.reserve(num_pixels);
  for (std::size_t i = 0; i < colours.size(); i += 4) {
    image.pixels.push_back(
        static_cast<std::uint8_t>((colours[i] + colours[i + 1] + colours[i + 2]) / 3));
  }
  return image;
}

}  // namespace hires::world
