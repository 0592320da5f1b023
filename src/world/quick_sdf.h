#pragma once

#include <functional>
#include <map>
#include <sdf/Element.hh>
#include <sdf/ParserConfig.hh>
#include <sdf/SDFImpl.hh>
#include <sdf/Types.hh>
#include <set>
#include <string>
#include <vector>

#include "world/resource_finder.h"
#include "world/xml_check.h"

namespace hires::world {

/// libsdformat's schema without large optional parts (sensors, joints, lights, ...) that a file
/// with these `elements` does not use. libsdformat copies the schema of each element it reads, so a
/// smaller one reads faster, to the same result. Made once for each selection; do not change it,
/// clone it. May be called from several threads.
sdf::ElementPtr SchemaFor(const std::set<std::string>& elements);

/// Reads SDF files as sdf::readFile does, with the schema of SchemaFor and each included file read
/// once. What libsdformat says goes to its console.
class QuickReader {
 public:
  /// @param inventory  of the file that is read, by CheckXmlFile with the same finder.
  /// @pre both outlive this.
  QuickReader(const ResourceFinder& finder, const XmlInventory& inventory);
  QuickReader(const QuickReader&) = delete;  // its callback knows where it is
  QuickReader& operator=(const QuickReader&) = delete;

  /// Nothing (nullptr) when in doubt: an error, an <include> with more than <uri>, <name>, <pose>
  /// and <static>, a file that is no SDF of version 1.6 to 1.9.
  sdf::SDFPtr Read(const std::string& path);

  /// The same for `text`, which is a part of the file and has its lines.
  sdf::SDFPtr ReadPart(const std::string& text, const std::string& path);

 private:
  using ReadInto = std::function<bool(const sdf::SDFPtr& document, sdf::Errors* errors)>;

  sdf::SDFPtr ReadBy(const ReadInto& read, const std::string& path);
  bool ResolveIncludes(const sdf::ElementPtr& parent);
  bool ReplaceIncludes(const sdf::ElementPtr& parent, const std::vector<sdf::ElementPtr>& children);
  sdf::ElementPtr Included(const sdf::ElementPtr& include);
  sdf::ElementPtr ModelIn(const std::string& path);

  const ResourceFinder& finder_;
  const XmlInventory& inventory_;
  sdf::ParserConfig config_;
  std::map<std::string, sdf::SDFPtr> documents_;  // of included files
};

}  // namespace hires::world
