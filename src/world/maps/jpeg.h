#pragma once

#include <string>

#include "world/maps/map_picture.h"

namespace hires::world {

bool IsJpeg(const std::string& bytes);

/// Reads a JPEG, grey or in colours. What it lost when it was saved is lost: edges of walls are
/// grey.
/// @param name  Stands for the file in messages.
/// @throws base::ConfigError: a broken file, more than 100 million pixels.
MapPicture ParseJpeg(const std::string& bytes, const std::string& name);

}  // namespace hires::world
