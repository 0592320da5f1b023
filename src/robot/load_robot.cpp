#include "hires/robot/load_robot.h"

#include <filesystem>

#include "hires/base/text.h"

namespace hires::robot {

Robot LoadAnyRobot(const std::string& path) {
  const std::string ending = base::ToLower(std::filesystem::path(path).extension().string());
  return ending == ".urdf" ? LoadRobotFromUrdf(path) : LoadRobot(path);
}

std::string ReadUrdfOf(const std::string& path, const RobotProfile& profile) {
  const auto folder = std::filesystem::path(path).parent_path();
  return base::ReadTextFile((folder / profile.urdf).lexically_normal().string());
}

}  // namespace hires::robot
