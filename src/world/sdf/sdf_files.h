#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "world/resource_finder.h"
#include "world/sdf/load_notes.h"
#include "world/xml_check.h"

namespace hires::world {

/// A <joint> of a <world>, as SDF has it from 1.10 on.
struct WorldJoint {
  std::string parent, child;  ///< as written: "world", a model, "model::link", a frame
  bool is_fixed;
  std::string place;  ///< "hall.world:12 'hinge'"
};

/// One SDF file, cut down to what is read of it.
struct SdfFile {
  std::string root;     ///< name of the outermost element
  std::string version;  ///< that `text` is in
  /// XML of what is read (PruneSdf), each element in its line of the file.
  std::string text;
  std::set<std::string> elements;               ///< names of all elements in `text`
  std::map<std::string, std::string> includes;  ///< URI -> file, of each <include> in `text`
  std::vector<WorldJoint> world_joints;
  /// Places of the <model> elements beside a <world>, of which the first alone is in `text`.
  std::vector<std::string> models_beside_world;
  int num_worlds{0}, num_models{0};  ///< that stand at its top, of `text`
  std::string model_name;            ///< of the first of these models
  /// Of what stands in that model, links and the like; empty where a merged model brings others.
  std::set<std::string> part_names;
  long num_elements{0};  ///< of `text`, included files as often as they are included
};
using SdfFiles = std::map<std::string, SdfFile>;  ///< by path

/// Reads a file and all that its <include> elements name, each once. What is left out or missing is
/// said to `notes`, and reading goes on: an <include> that leads nowhere becomes a model without
/// shapes.
/// @throws base::ConfigError if `path` itself is not there, no XML, or too large.
SdfFiles ReadSdfFiles(const std::string& path, const ResourceFinder& finder,
                      const XmlLimits& limits, LoadNotes* notes);

}  // namespace hires::world
