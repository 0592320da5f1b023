#pragma once

#include <string>

#include "world/maps/map_picture.h"

namespace hires::world {

bool IsBmp(const std::string& bytes);

/// Reads a Windows bitmap: 1, 4 or 8 bit with a palette (8 and 4 bit also packed, RLE), 16, 24 or
/// 32 bit in colours. The fourth byte of 32 bit counts as transparency where a header says so, or
/// where not all of them are 0, as SDL has it.
/// @param name  Stands for the file in messages.
/// @throws base::ConfigError: a broken file, more than 100 million pixels, packed as PNG or JPEG.
MapPicture ParseBmp(const std::string& bytes, const std::string& name);

}  // namespace hires::world
