#pragma once

#include <map>
#include <set>
#include <string>

#include "world/resource_finder.h"

namespace hires::world {

/// What one SDF or URDF file and all it includes may hold, so that no file exhausts memory or
/// stack. Files that are included twice count twice.
struct XmlLimits {
  std::size_t max_file_bytes{16u << 20};
  int max_element_depth{64};
  int max_include_depth{16};
  int max_elements{200000};
};

/// What one file holds, by names alone.
struct XmlFileInventory {
  std::string root;                ///< name of the outermost element, empty if there is none
  std::string version;             ///< its attribute, or empty
  std::set<std::string> elements;  ///< names of all elements
};
using XmlInventory = std::map<std::string, XmlFileInventory>;  ///< by path

/// Checks well-formedness, size and depth of the XML in `text` without looking at its meaning.
/// @throws base::ConfigError naming `path` and line.
void CheckXml(const std::string& text, const std::string& path, const XmlLimits& limits = {});

/// The same for a file and all files that its <include> elements name.
/// @throws base::ConfigError as CheckXml; a circle of includes; files, models and meshes of
/// collisions that are not there, all at once.
XmlInventory CheckXmlFile(const std::string& path, const ResourceFinder& finder,
                          const XmlLimits& limits = {});

}  // namespace hires::world
