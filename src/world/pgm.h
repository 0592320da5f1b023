#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hires::world {

inline constexpr std::int64_t kMaxPixels = 100'000'000;  ///< of an image that is read

/// A grey image, row by row from the top, scaled to 0 (black) .. 255 (white).
struct GreyImage {
  int width{0};
  int height{0};
  std::vector<std::uint8_t> pixels;
};

/// Reads netpbm's grey images, plain (P2) and raw (P5), with 1 or 2 bytes for a sample.
/// @param name  Stands for the file in messages.
/// @throws base::ConfigError: another format, malformed header, more than 100 million pixels,
/// values that are missing or above the maximum.
GreyImage ParsePgm(const std::string& bytes, const std::string& name);

std::string FormatPgm(const GreyImage& image);  ///< P5, one byte for a sample

}  // namespace hires::world
