#include "world/maps/map_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "world/maps/bmp.h"
#include "world/maps/jpeg.h"
#include "world/maps/png.h"
#include "world/maps/pnm.h"

namespace hires::world {
namespace {

struct OtherFormat {
  std::string_view begin, name;
};
// What is met as well, and what no map server reads or hardly any.
constexpr std::array<OtherFormat, 9> kOthers{{{"GIF8", "a GIF"},
                                              {"II*", "a TIFF"},
                                              {"MM", "a TIFF"},
                                              {"RIFF", "a WebP"},
                                              {"gimp xcf", "a file of GIMP"},
                                              {"<svg", "an SVG"},
                                              {"<?xml", "XML"},
                                              {"%PDF", "a PDF"},
                                              {"version https://git-lfs", "a pointer of Git LFS"}}};

std::string KindOf(const std::string& bytes) {
  for (const OtherFormat& other : kOthers) {
    if (std::string_view(bytes).substr(0, other.begin.size()) == other.begin)
      return fmt::format("is {}", other.name);
  }
  return bytes.empty() ? "is empty" : "is no picture of a kind that is known";
}

}  // namespace

void RequirePictureSize(std::int64_t width, std::int64_t height, const std::string& name) {
  if (width < 1 || height < 1) {
    throw base::ConfigError(
        fmt::format("{}: is {} x {} pixels, wanted 1 or more each way; save "
                    "the image again",
                    name, width, height));
  }
  // Neither is large enough for the product to overflow.
  if (width <= kMaxPixels && height <= kMaxPixels && width * height <= kMaxPixels) return;
  throw base::ConfigError(
      fmt::format("{}: has {} x {} pixels, at most {} are read; scale it down, and `resolution` up",
                  name, width, height, kMaxPixels));
}

MapPicture ParseMapPicture(const std::string& bytes, const std::string& name) {
  if (IsPng(bytes)) return ParsePng(bytes, name);
  if (IsPnm(bytes)) return ParsePnm(bytes, name);
  if (IsBmp(bytes)) return ParseBmp(bytes, name);
  if (IsJpeg(bytes)) return ParseJpeg(bytes, name);
  throw base::ConfigError(
      fmt::format("{}: {}; wanted a PGM, PNG, BMP or JPEG: convert it, to PGM or PNG best", name,
                  KindOf(bytes)));
}

bool IsPictureName(const std::string& path) {
  constexpr std::array<std::string_view, 8> kEndings{".pgm", ".png", ".bmp",  ".jpg",
                                                     ".ppm", ".pbm", ".jpeg", ".pnm"};
  const std::string ending = base::ToLower(std::filesystem::path(path).extension().string());
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

}  // namespace hires::world
