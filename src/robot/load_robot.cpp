#include "hires/robot/load_robot.h"

#include <fmt/format.h>

#include <filesystem>

#include "hires/base/error.h"
#include "hires/base/param_reader.h"
#include "hires/base/text.h"
#include "robot/urdf/urdf_file.h"

namespace hires::robot {
namespace {

std::string EndingOf(const std::string& file) {
  return base::ToLower(std::filesystem::path(file).extension().string());
}

}  // namespace

Robot LoadAnyRobot(const std::string& path) {
  const std::string file = FileOfRobot(path), ending = EndingOf(file);
  if (ending == ".urdf" || ending == ".xacro") return LoadRobotFromUrdf(path);
  if (!IsProfile(path)) {
    throw base::ConfigError(fmt::format(
        "{}: unknown file type '{}' for a robot; wanted a profile (.yaml), a URDF (.urdf) or a "
        "xacro file of one (.xacro)",
        file, ending));
  }
  return LoadRobot(path);
}

std::string FileOfRobot(const std::string& path) { return SplitArguments(path).path; }

bool IsProfile(const std::string& path) {
  const std::string ending = EndingOf(FileOfRobot(path));
  return ending == ".yaml" || ending == ".yml";
}

bool IsMotionAssumed(const std::string& path) {
  if (!IsProfile(path)) return true;
  base::ParamReader in = base::ParamReader::FromFile(path);
  return !in.Has("motion_sets") &&
         !(in.Has("base_controller") && in.Sub("base_controller").Has("limits"));
}

std::string ReadUrdfOf(const std::string& path, const RobotProfile& profile) {
  return ReadUrdfFile(UrdfOf(path, profile));
}

}  // namespace hires::robot
