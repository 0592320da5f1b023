#pragma once

#include <sdf/Element.hh>
#include <sdf/Error.hh>
#include <sdf/Root.hh>
#include <string>

#include "world/resource_finder.h"
#include "world/xml_check.h"

namespace hires::world {

/// Both ways give the same result; the quick one falls back on the straight one whenever
/// libsdformat objects to anything, so that the messages are the same as well. Only the quick one
/// follows <include> in included models (libsdformat 12 forgets there where to look).
enum class ReadingWay {
  kQuick,     ///< as ReadDocumentQuickly
  kStraight,  ///< sdf::readFile
};

/// Reads an SDF file with libsdformat. Nothing is printed; what libsdformat would print as a
/// warning goes to base::Log.
/// @throws base::ConfigError: not there, malformed XML, too large, too deep, includes that are
/// missing or go round in a circle, everything that libsdformat objects to (all in one message,
/// each with file and line).
sdf::Root ReadSdf(const std::string& path, const ResourceFinder& finder,
                  const XmlLimits& limits = {}, ReadingWay way = ReadingWay::kQuick);

/// "file:line", as far as known.
std::string PlaceOf(const sdf::ElementPtr& element);

/// @throws base::ConfigError that lists `errors`, if there are any.
void ThrowIfAny(const sdf::Errors& errors, const std::string& path);

}  // namespace hires::world
