#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace hires::perception {

/// Red, green, blue.
using Colour = std::array<std::uint8_t, 3>;

/// Pixels row by row, from the top left one.
struct Picture {
  Picture() = default;
  Picture(int width_in, int height_in, const Colour& colour = {})
      : width(width_in),
        height(height_in),
        pixels(static_cast<std::size_t>(width_in) * height_in, colour) {}

  Colour& At(int column, int row) { return pixels[static_cast<std::size_t>(row) * width + column]; }
  const Colour& At(int column, int row) const {
    return pixels[static_cast<std::size_t>(row) * width + column];
  }

  int width{0}, height{0};
  std::vector<Colour> pixels;
};

}  // namespace hires::perception
