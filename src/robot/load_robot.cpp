#include "hires/robot/load_robot.h"

#include <fmt/format.h>

#include <filesystem>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::robot {

Robot LoadAnyRobot(const std::string& path) {
  const std::string ending = base::ToLower(std::filesystem::path(path).extension().string());
  if (ending == ".urdf") return LoadRobotFromUrdf(path);
  if (ending != ".yaml" && ending != ".yml") {
    throw base::ConfigError(fmt::format(
        "{}: is no robot by its ending '{}'; wanted a profile (.yaml) or a URDF (.urdf)", path,
        ending));
  }
  return LoadRobot(path);
}

std::string ReadUrdfOf(const std::string& path, const RobotProfile& profile) {
  const auto folder = std::filesystem::path(path).parent_path();
  return base::ReadTextFile((folder / profile.urdf).lexically_normal().string());
}

}  // namespace hires::robot
