#pragma once

#include <string>
#include <vector>

#include "hires/imagination/imagination_setup.h"

namespace hires_ros {

/// The private parameters of a node that OverrideScene() reads, and `others`.
std::vector<std::string> WithSceneParams(std::vector<std::string> others);

/// What a node that imagines is told of its scene beside the scene's file: ~world or ~map, ~areas
/// (a file of goals or waypoints), ~robot, ~objects, ~uncertainty, ~guard, ~action_libraries. What
/// is not given or empty stays.
/// @throws hires::base::ConfigError also for a world and a map, and with all faults of the areas.
void OverrideScene(hires::imagination::SetupConfig* scene);

}  // namespace hires_ros
