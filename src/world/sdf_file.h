#pragma once

#include <functional>
#include <optional>
#include <sdf/Element.hh>
#include <sdf/Error.hh>
#include <sdf/Root.hh>
#include <string>
#include <vector>

#include "world/resource_finder.h"
#include "world/sdf/load_notes.h"
#include "world/sdf/sdf_files.h"
#include "world/xml_check.h"

namespace hires::world {

/// Reads an SDF file with libsdformat, cut down to what is needed (PruneSdf). Nothing is printed;
/// what libsdformat would print as a warning goes to base::Log.
/// @param notes  gets what is left out, and all that keeps the file from being read, each with file
/// and line: includes that are missing or go round in a circle, what libsdformat objects to.
/// @return what could be read; null if that is nothing.
/// @throws base::ConfigError: the file itself is not there, malformed XML, too large, too deep.
std::optional<sdf::Root> ReadSdf(const std::string& path, const ResourceFinder& finder,
                                 LoadNotes* notes, const XmlLimits& limits = {});

/// What was read of a world in one go.
struct SdfWorldPart {
  const sdf::World& world;
  const std::vector<std::size_t>& places;  ///< of its models among all of the file, by their order
  bool is_first;                           ///< has all that is no model
};

/// ReadSdfFiles for a world; a file of one static model, such as a building, is read as a world
/// that has it, with a note.
/// @throws base::ConfigError as that; a file of another kind, told by its kind, with the option
/// that takes it; if there is not one world.
SdfFiles ReadWorldFiles(const std::string& path, const ResourceFinder& finder, LoadNotes* notes);

/// Reads the only world of an SDF file as ReadSdf does, in parts if it has many models, so that the
/// memory of libsdformat's trees is needed for one part at a time.
/// @param files  by ReadWorldFiles.
void ReadSdfWorld(const SdfFiles& files, const std::string& path, std::size_t models_per_part,
                  LoadNotes* notes, const std::function<void(const SdfWorldPart&)>& use);

/// "file:line", as far as known.
std::string PlaceOf(const sdf::ElementPtr& element);

/// @throws base::ConfigError that lists `errors`, if there are any.
void ThrowIfAny(const sdf::Errors& errors, const std::string& path);

}  // namespace hires::world
