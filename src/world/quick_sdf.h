#pragma once

#include <map>
#include <sdf/Element.hh>
#include <sdf/ParserConfig.hh>
#include <sdf/SDFImpl.hh>
#include <sdf/Types.hh>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "world/sdf/load_notes.h"
#include "world/sdf/sdf_files.h"

namespace hires::world {

/// libsdformat's schema without large optional parts (sensors, joints, lights, ...) that a file
/// with these `elements` does not use. libsdformat copies the schema of each element it reads, so a
/// smaller one reads faster, to the same result. Made once for each selection; do not change it,
/// clone it. May be called from several threads.
sdf::ElementPtr SchemaFor(const std::set<std::string>& elements);

/// Reads SDF files as sdf::readFile does, with the schema of SchemaFor, each included file once,
/// and includes in included files as well. What libsdformat has to object to goes to the notes or
/// to its console.
class QuickReader {
 public:
  /// @param files  by ReadSdfFiles.
  /// @pre both outlive this.
  QuickReader(const SdfFiles& files, LoadNotes* notes);
  QuickReader(const QuickReader&) = delete;  // its callback knows where it is
  QuickReader& operator=(const QuickReader&) = delete;

  /// Nothing (nullptr) if libsdformat refuses the file.
  sdf::SDFPtr Read(const std::string& path);

  /// The same for `text`, which is a part of the file and has its lines.
  sdf::SDFPtr ReadPart(const std::string& text, const std::string& path);

 private:
  void ResolveIncludes(const sdf::ElementPtr& parent, const std::string& path);
  sdf::ElementPtr Included(const sdf::ElementPtr& include, const std::string& path);
  sdf::ElementPtr ModelIn(const std::string& path);
  void NamePartsOf(const sdf::ElementPtr& include, const std::string& path,
                   const sdf::ElementPtr& parent);
  void NamePartsBeside(const sdf::ElementPtr& model, const sdf::ElementPtr& parent);

  const SdfFiles& files_;
  LoadNotes* notes_;
  sdf::ParserConfig config_;
  std::map<std::string, sdf::SDFPtr> documents_;  // of included files
  /// Names and scope of what is merged into a model.
  std::map<sdf::ElementPtr, std::vector<std::pair<std::set<std::string>, std::string>>> merged_;
};

/// Each of libsdformat's errors as a problem, with file and line as far as known.
void AddErrors(const sdf::Errors& errors, const std::string& path, LoadNotes* notes);

}  // namespace hires::world
