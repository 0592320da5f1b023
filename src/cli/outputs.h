#pragma once

#include <string>
#include <vector>

namespace hires::cli {

/// A file that a verb reads or writes.
struct VerbFile {
  std::string what;            ///< of an output its option, "--json"; of an input what it is, "map"
  std::string path;            ///< empty: none
  bool may_be_printed{false};  ///< of an output: "-" is standard output
};

/// What is typed of a scene in most verbs, as inputs: with the map's picture, the robot's file
/// without arguments of xacro, and the files of goals among the areas.
std::vector<VerbFile> SceneFiles(const std::string& world, const std::string& map,
                                 const std::string& robot, const std::vector<std::string>& areas);

/// The picture that a map names, as an input.
/// @param map  YAML of map_server; empty: none.
VerbFile PictureFile(const std::string& map);

/// Before the work: each output can be written, is none of the inputs and no other output. Every
/// verb that writes asks this of all that it writes and reads.
/// @throws base::ConfigError with all that is wrong
void CheckOutputs(const std::vector<VerbFile>& outputs, const std::vector<VerbFile>& inputs);

}  // namespace hires::cli
