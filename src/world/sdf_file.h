#pragma once

#include <functional>
#include <sdf/Element.hh>
#include <sdf/Error.hh>
#include <sdf/Root.hh>
#include <string>
#include <vector>

#include "world/resource_finder.h"
#include "world/xml_check.h"

namespace hires::world {

/// Both ways give the same result; the quick one falls back on the straight one whenever
/// libsdformat objects to anything, so that the messages are the same as well. Only the quick one
/// follows <include> in included models (libsdformat 12 forgets there where to look).
enum class ReadingWay {
  kQuick,     ///< as QuickReader
  kStraight,  ///< sdf::readFile
};

/// Reads an SDF file with libsdformat. Nothing is printed; what libsdformat would print as a
/// warning goes to base::Log.
/// @throws base::ConfigError: not there, malformed XML, too large, too deep, includes that are
/// missing or go round in a circle, everything that libsdformat objects to (all in one message,
/// each with file and line).
sdf::Root ReadSdf(const std::string& path, const ResourceFinder& finder,
                  const XmlLimits& limits = {}, ReadingWay way = ReadingWay::kQuick);

/// What was read of a world in one go.
struct SdfWorldPart {
  const sdf::World& world;
  const std::vector<std::size_t>& places;  ///< of its models among all of the file, by their order
  bool is_first;                           ///< has all that is no model
};

/// Reads the only world of an SDF file as ReadSdf does, in parts if it has many models, so that the
/// memory of libsdformat's trees is needed for one part at a time. Where libsdformat has anything
/// to object to, it begins again, with the whole as the first part.
/// @throws base::ConfigError as ReadSdf, and if there is not one world.
void ReadSdfWorld(const std::string& path, const ResourceFinder& finder,
                  std::size_t models_per_part, const std::function<void(const SdfWorldPart&)>& use);

/// "file:line", as far as known.
std::string PlaceOf(const sdf::ElementPtr& element);

/// @throws base::ConfigError that lists `errors`, if there are any.
void ThrowIfAny(const sdf::Errors& errors, const std::string& path);

}  // namespace hires::world
