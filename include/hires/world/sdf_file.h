#pragma once

#include <sdf/Element.hh>
#include <sdf/Error.hh>
#include <sdf/Root.hh>
#include <string>

#include "hires/world/resource_finder.h"

namespace hires::world {

/// What one SDF or URDF file and all it includes may hold, so that no file exhausts memory or
/// stack. Files that are included twice count twice.
struct XmlLimits {
  std::size_t max_file_bytes{16u << 20};
  int max_element_depth{64};
  int max_include_depth{16};
  int max_elements{200000};
};

/// Reads an SDF file with libsdformat. Nothing is printed; what libsdformat would print as a
/// warning goes to base::Log.
/// @throws base::ConfigError: not there, malformed XML, too large, too deep, includes that are
/// missing or go round in a circle, everything that libsdformat objects to (all in one message,
/// each with file and line).
sdf::Root ReadSdf(const std::string& path, const ResourceFinder& finder,
                  const XmlLimits& limits = {});

/// Checks well-formedness, size and depth of the XML in `text` without looking at its meaning.
/// @throws base::ConfigError naming `path` and line.
void CheckXml(const std::string& text, const std::string& path, const XmlLimits& limits = {});

/// "file:line", as far as known.
std::string PlaceOf(const sdf::ElementPtr& element);

/// @throws base::ConfigError that lists `errors`, if there are any.
void ThrowIfAny(const sdf::Errors& errors, const std::string& path);

}  // namespace hires::world
