#include "world/maps/jpeg.h"

#include <fmt/format.h>
// clang-format off
#include <cstdio>  // jpeglib.h needs it
#include <jpeglib.h>
// clang-format on

#include <csetjmp>
#include <utility>

#include "hires/base/error.h"

namespace hires::world {
namespace {

/// What libjpeg's functions are handed. It reports an error by a jump, which must pass no
/// destructor: all that owns memory lives here, outside of the functions that it jumps out of.
struct JpegReading {
  jpeg_error_mgr errors{};  // first: libjpeg knows its address, and we find ourselves by it
  std::jmp_buf jump{};
  char error[JMSG_LENGTH_MAX]{};
  jpeg_decompress_struct jpeg{};
  std::vector<std::uint8_t> row;
  MapPicture picture;

  JpegReading() {
    jpeg.err = jpeg_std_error(&errors);
    errors.error_exit = [](j_common_ptr about) {
      auto* reading = reinterpret_cast<JpegReading*>(about->err);
      about->err->format_message(about, reading->error);
      std::longjmp(reading->jump, 1);
    };
    errors.emit_message = [](j_common_ptr, int) {};
  }
  JpegReading(const JpegReading&) = delete;
  JpegReading& operator=(const JpegReading&) = delete;
  ~JpegReading() { jpeg_destroy_decompress(&jpeg); }
};

bool ReadHeader(const std::string& bytes, JpegReading* reading) {
  if (setjmp(reading->jump) != 0) return false;
  jpeg_create_decompress(&reading->jpeg);
  jpeg_mem_src(&reading->jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&reading->jpeg, TRUE);
  if (reading->jpeg.jpeg_color_space != JCS_GRAYSCALE) reading->jpeg.out_color_space = JCS_RGB;
  return true;
}

/// @pre the row and the picture's colours have their size.
bool ReadRows(JpegReading* reading) {
  if (setjmp(reading->jump) != 0) return false;
  jpeg_decompress_struct& jpeg = reading->jpeg;
  jpeg_start_decompress(&jpeg);
  std::uint16_t* out = reading->picture.colours.data();
  while (jpeg.output_scanline < jpeg.output_height) {
    JSAMPROW row = reading->row.data();
    jpeg_read_scanlines(&jpeg, &row, 1);
    const std::uint8_t* p = row;
    for (JDIMENSION x = 0; x < jpeg.output_width; ++x, p += jpeg.output_components) {
      *out++ = jpeg.output_components == 1 ? SumOfGrey(p[0])
                                           : static_cast<std::uint16_t>(p[0] + p[1] + p[2]);
    }
  }
  jpeg_finish_decompress(&jpeg);
  // Data that ends early or is damaged is filled up with grey, which is no map.
  if (jpeg.err->num_warnings == 0) return true;
  std::snprintf(reading->error, sizeof(reading->error), "its data is damaged or ends too early");
  return false;
}

}  // namespace

bool IsJpeg(const std::string& bytes) { return bytes.compare(0, 3, "\xff\xd8\xff") == 0; }

MapPicture ParseJpeg(const std::string& bytes, const std::string& name) {
  JpegReading reading;
  const auto fail = [&] {
    throw base::ConfigError(
        fmt::format("{}: is a broken JPEG: {}; save the image again", name, reading.error));
  };
  if (!ReadHeader(bytes, &reading)) fail();
  const std::size_t width = reading.jpeg.image_width, height = reading.jpeg.image_height;
  RequirePictureSize(static_cast<std::int64_t>(width), static_cast<std::int64_t>(height), name);
  reading.picture.width = static_cast<int>(width);
  reading.picture.height = static_cast<int>(height);
  reading.picture.colours.resize(width * height);
  reading.row.resize(4 * width);
  if (!ReadRows(&reading)) fail();
  return std::move(reading.picture);
}

}  // namespace hires::world
