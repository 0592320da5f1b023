#pragma once

#include <string>

namespace hires::world {

/// The SDF that libsdformat makes of a URDF that a world includes. It drops links without mass, be
/// it that they have shapes, with all that hangs on them: where shapes would be lost so, those
/// links get a mass for the conversion, and none in what comes out of it.
/// @param xml  plain: see base::PlainXml.
/// @throws base::ConfigError naming the file where it is no URDF.
std::string SdfTextOfUrdf(const std::string& xml, const std::string& path);

}  // namespace hires::world
