#pragma once

#include <string>

#include "world/pgm.h"

namespace hires::world {

bool IsPng(const std::string& bytes);

/// Reads any PNG as a grey image: the mean of its colours, transparency left out, as map_server
/// does.
/// @param name  Stands for the file in messages.
/// @throws base::ConfigError: a broken file, more than 100 million pixels.
GreyImage ParsePng(const std::string& bytes, const std::string& name);

}  // namespace hires::world
