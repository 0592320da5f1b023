#pragma once

#include <string>
#include <vector>

#include "hires/robot/robot_profile.h"

namespace hires::robot {

/// Links that are seen where nothing of the robot collides: outside its footprint or above its
/// shapes. Meshes are read where a link has no shape of its own. One that is not read counts where
/// its origin is there, and where it is the base's, of which hardly anything collides. A sentence
/// with what to write; "" where there are none.
/// @param bounds  LinkBounds(robot)
/// @param urdf_path  of the file that `urdf_xml` is of: paths of meshes are seen from its folder.
std::string SeenText(const Robot& robot, const std::vector<geometry::Aabb>& bounds,
                     const std::string& urdf_xml, const std::string& urdf_path);

}  // namespace hires::robot
