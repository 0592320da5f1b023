#include "world/maps/png.h"

#include <fmt/format.h>
#include <png.h>

#include <csetjmp>
#include <cstring>

#include "hires/base/error.h"

namespace hires::world {
namespace {

/// What libpng's functions are handed. It reports an error by a jump, which must pass no
/// destructor: all that owns memory lives here, outside of the functions that it jumps out of.
struct Reading {
  const std::string& bytes;
  std::size_t at{0};
  std::string error;
  int width{0}, height{0}, num_channels{0};
  std::vector<std::uint8_t> samples;
  std::vector<png_bytep> rows;
  png_structp png{nullptr};
  png_infop info{nullptr};

  explicit Reading(const std::string& from) : bytes(from) {}
  Reading(const Reading&) = delete;
  Reading& operator=(const Reading&) = delete;
  ~Reading() { png_destroy_read_struct(&png, &info, nullptr); }
};

void OnError(png_structp png, png_const_charp message) {
  static_cast<Reading*>(png_get_error_ptr(png))->error = message;
  png_longjmp(png, 1);
}
void OnWarning(png_structp, png_const_charp) {}

void OnRead(png_structp png, png_bytep out, png_size_t size) {
  auto* reading = static_cast<Reading*>(png_get_io_ptr(png));
  if (reading->bytes.size() - reading->at < size) png_error(png, "it ends too early");
  std::memcpy(out, reading->bytes.data() + reading->at, size);
  reading->at += size;
}

/// @return whether it went well; else Reading::error says why.
bool ReadHeader(Reading* reading) {
  if (setjmp(png_jmpbuf(reading->png)) != 0) return false;
  png_set_read_fn(reading->png, reading, OnRead);
  png_set_user_limits(reading->png, 0x7fffffff, 0x7fffffff);  // ours come next, in our words
  png_read_info(reading->png, reading->info);
  png_set_strip_16(reading->png);  // the upper byte of each sample
  png_set_expand(reading->png);    // palettes become colours, 1 to 4 bit 8, tRNS an alpha channel
  reading->width = static_cast<int>(png_get_image_width(reading->png, reading->info));
  reading->height = static_cast<int>(png_get_image_height(reading->png, reading->info));
  png_set_interlace_handling(reading->png);
  png_read_update_info(reading->png, reading->info);
  reading->num_channels = png_get_channels(reading->png, reading->info);
  return true;
}

/// @pre the rows are there.
bool ReadRows(Reading* reading) {
  if (setjmp(png_jmpbuf(reading->png)) != 0) return false;
  png_read_image(reading->png, reading->rows.data());
  return true;
}

MapPicture PictureOf(const Reading& reading) {
  MapPicture picture{reading.width, reading.height, {}, {}};
  const int num_channels = reading.num_channels;
  const bool is_grey = num_channels < 3, has_alpha = num_channels % 2 == 0;
  const std::size_t num_pixels = static_cast<std::size_t>(reading.width) * reading.height;
  picture.colours.reserve(num_pixels);
  if (has_alpha) picture.alpha.reserve(num_pixels);
  const std::uint8_t* end = reading.samples.data() + reading.samples.size();
  for (const std::uint8_t* p = reading.samples.data(); p != end; p += num_channels) {
    picture.colours.push_back(is_grey ? SumOfGrey(p[0])
                                      : static_cast<std::uint16_t>(p[0] + p[1] + p[2]));
    if (has_alpha) picture.alpha.push_back(p[num_channels - 1]);
  }
  return picture;
}

}  // namespace

bool IsPng(const std::string& bytes) { return bytes.compare(0, 4, "\x89PNG") == 0; }

MapPicture ParsePng(const std::string& bytes, const std::string& name) {
  Reading reading(bytes);
  reading.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reading, OnError, OnWarning);
  reading.info = png_create_info_struct(reading.png);
  const auto fail = [&] {
    throw base::ConfigError(
        fmt::format("{}: is a broken PNG: {}; save the image again", name, reading.error));
  };
  if (!ReadHeader(&reading)) fail();
  RequirePictureSize(reading.width, reading.height, name);
  const std::size_t row_bytes = static_cast<std::size_t>(reading.width) * reading.num_channels;
  reading.samples.resize(row_bytes * reading.height);
  for (int row = 0; row < reading.height; ++row) {
    reading.rows.push_back(reading.samples.data() + row * row_bytes);
  }
  if (!ReadRows(&reading)) fail();
  return PictureOf(reading);
}

}  // namespace hires::world
