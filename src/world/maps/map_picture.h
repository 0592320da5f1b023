#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hires::world {

inline constexpr std::int64_t kMaxPixels = 100'000'000;  ///< of a picture that is read

/// A map's picture, row by row from the top. What stands in the file, without any gamma: of samples
/// of 16 bit the upper byte, of a palette its colours.
struct MapPicture {
  int width{0};
  int height{0};
  std::vector<std::uint16_t> colours;  ///< red + green + blue, 0 (black) .. 765 (white)
  std::vector<std::uint8_t> alpha;     ///< 0 (transparent) .. 255; empty: the file has none
};

inline std::uint16_t SumOfGrey(int grey) { return static_cast<std::uint16_t>(3 * grey); }

/// @throws base::ConfigError: "a.pgm: has ... pixels", where there are none or too many.
void RequirePictureSize(std::int64_t width, std::int64_t height, const std::string& name);

/// Reads a PNG, a netpbm picture (P1 to P6), a BMP or a JPEG, told by its first bytes.
/// @param name  Stands for the file in messages.
/// @throws base::ConfigError: broken, too large, or of another format, which is named.
MapPicture ParseMapPicture(const std::string& bytes, const std::string& name);

/// Whether a file of this name is a picture by its ending, of a kind that is read.
bool IsPictureName(const std::string& path);

}  // namespace hires::world
