#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "world/maps/map_picture.h"

namespace hires::world {

/// A grey image, row by row from the top, scaled to 0 (black) .. 255 (white).
struct GreyImage {
  int width{0};
  int height{0};
  std::vector<std::uint8_t> pixels;
};

bool IsPnm(const std::string& bytes);

/// Reads netpbm's pictures: black and white (P1, P4), grey (P2, P5) and in colours (P3, P6), plain
/// and raw, with 1 or 2 bytes for a sample.
/// @param name  Stands for the file in messages.
/// @throws base::ConfigError: malformed header, more than 100 million pixels, values that are
/// missing or above the maximum.
MapPicture ParsePnm(const std::string& bytes, const std::string& name);

std::string FormatPgm(const GreyImage& image);  ///< P5, one byte for a sample

}  // namespace hires::world
