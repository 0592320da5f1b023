#include "hires/ros/imagination/scene_params.h"

#include <fmt/format.h>

#include "hires/base/error.h"
#include "hires/ros/node/private_params.h"
#include "imagination/area_file.h"

namespace hires_ros {

namespace imagination = hires::imagination;

std::vector<std::string> WithSceneParams(std::vector<std::string> others) {
  others.insert(others.end(), {"world", "map", "areas", "robot", "objects", "uncertainty", "guard",
                               "action_libraries"});
  return others;
}

void OverrideScene(imagination::SetupConfig* scene) {
  const std::string world = PrivateText("world").value_or("");
  const std::string map = PrivateText("map").value_or("");
  if (!world.empty() && !map.empty()) {
    throw hires::base::ConfigError(fmt::format(
        "~world is '{}' and ~map '{}', wanted one of them: the walls of a map are the world", world,
        map));
  }
  imagination::OverridePaths(world, PrivateText("robot"), PrivateText("objects"),
                             PrivateText("uncertainty"), scene);
  if (!map.empty()) scene->map = map;
  const std::string areas = PrivateText("areas").value_or("");
  if (!areas.empty()) scene->areas = imagination::ReadAreaFile(areas);
  scene->has_base_guard = PrivateBool("guard").value_or(scene->has_base_guard);
  scene->action_libraries = PrivateActionLibraries();
}

}  // namespace hires_ros
