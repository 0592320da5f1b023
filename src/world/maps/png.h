#pragma once

#include <string>

#include "world/maps/map_picture.h"

namespace hires::world {

bool IsPng(const std::string& bytes);

/// Reads any PNG: grey, colours or palette, each with transparency or without, 1 to 16 bit a
/// sample. No gamma is applied, whatever the file says of one: it is a map and no photograph.
/// @param name  Stands for the file in messages.
/// @throws base::ConfigError: a broken file, more than 100 million pixels.
MapPicture ParsePng(const std::string& bytes, const std::string& name);

}  // namespace hires::world
