#pragma once

#include <string>
#include <vector>

#include "hires/imagination/imagination_setup.h"

namespace hires::imagination {

/// Reads places to stand at out of a YAML file of goals or waypoints as navigation tools have them,
/// in lists or by name, under whatever keys:
/// - [x, y], [x, y, yaw] or [x, y, z, qx, qy, qz, qw];
/// - {x, y} with yaw, theta, th, heading or angle [rad], or with yaw_deg [degrees];
/// - {position, orientation} of geometry_msgs, in maps or lists (x, y, z, w), with a header or
///   without, below pose, target_pose and the like; several documents as `rostopic echo` prints
///   them;
/// - {pose: [x, y, z], orientation: [w, x, y, z]}, as the panel of Nav2 for RViz saves them.
/// Names are those of the keys, or of `name`, `id` or `label` beside a pose; others are called
/// goal1, goal2, ... by their number in the file. What is assumed (no yaw: 0) or left out (heights)
/// is logged once for each kind, with the first place.
/// @throws base::ConfigError with all that is wrong, each with its line.
std::vector<NamedArea> ReadAreaFile(const std::string& path);

/// @throws base::ConfigError: too far away, or called as another area of the world.
void AddAreas(const std::vector<NamedArea>& areas, world::World* world);

}  // namespace hires::imagination
