#pragma once

#include <sdf/Element.hh>
#include <sdf/SDFImpl.hh>
#include <set>
#include <string>

#include "world/resource_finder.h"
#include "world/xml_check.h"

namespace hires::world {

/// libsdformat's schema without large optional parts (sensors, joints, lights, ...) that a file
/// with these `elements` does not use. libsdformat copies the schema of each element it reads, so a
/// smaller one reads faster, to the same result. Made once for each selection; do not change it,
/// clone it. May be called from several threads.
sdf::ElementPtr SchemaFor(const std::set<std::string>& elements);

/// Reads an SDF file as sdf::readFile does, with the schema of SchemaFor and each included file
/// read once. Nothing (nullptr) when in doubt: an error, an <include> with more than <uri>, <name>,
/// <pose> and <static>, a file that is no SDF of version 1.6 to 1.9. What libsdformat says goes to
/// its console.
/// @param inventory  of `path`, by CheckXmlFile with the same finder.
sdf::SDFPtr ReadDocumentQuickly(const std::string& path, const ResourceFinder& finder,
                                const XmlInventory& inventory);

}  // namespace hires::world
