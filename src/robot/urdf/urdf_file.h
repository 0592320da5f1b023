#pragma once

#include <string>
#include <vector>

#include "hires/robot/robot_profile.h"

namespace hires::robot {

/// A file of a robot, and what xacro gets beside it.
struct UrdfFile {
  std::string path;
  std::vector<std::string> arguments;  ///< "prefix:=a_"
};

/// "bot.xacro prefix:=a_ arm:=false" taken apart. A name that is a file's as a whole is one, with
/// all its blanks.
UrdfFile SplitArguments(const std::string& path_and_arguments);

/// The other way round.
std::string TextOf(const UrdfFile& file);

/// What a profile names, as seen from the folder of the profile (or of a URDF in its place), or in
/// a package (package://).  @throws base::ConfigError as base::PackageFinder::Find.
UrdfFile UrdfOf(const std::string& profile_path, const RobotProfile& profile);

/// Whether a robot's text still has to be expanded: it is in a file .xacro, or has elements xacro:
/// or ${...} or $(...) where a robot is read from: not in comments, looks, transmissions or
/// plugins, whose files a simulator looks for. What was expanded may keep its xmlns:xacro.
bool IsXacro(const std::string& text, const std::string& path);

/// The URDF in a file. Of a xacro file it is what the program `xacro` on PATH makes of it, which
/// has kXacroLimit seconds; what it says on its error output is logged as a warning.
/// @throws base::ConfigError: the file cannot be read; arguments for a file that takes none; xacro
/// is not there (it names the command that would make a URDF of it), fails (with all it says), says
/// nothing or takes too long.
std::string ReadUrdfFile(const UrdfFile& file);

inline constexpr double kXacroLimit = 30.0;  ///< [s]

}  // namespace hires::robot
