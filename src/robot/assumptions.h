#pragma once

#include <functional>
#include <string>
#include <vector>

#include "hires/robot/robot_profile.h"

namespace hires::robot {

/// What no file says of the robot and yet what it does rests on, one sentence each, with what to
/// write: footprint, what is seen and collides with nothing, joints that stand at zero, height of
/// the base, laser, tray, drive, what of its motion is a PR2's.
/// @param is_given  whether the profile has a key, or "key.key"; none is given where a bare URDF
/// was loaded.
/// @param urdf_xml  text that the model is of.
/// @param urdf_path  file that it came from: meshes of looks are looked for as seen from there.
std::vector<std::string> AssumptionsOf(const Robot& robot,
                                       const std::function<bool(const std::string&)>& is_given,
                                       const std::string& urdf_xml, const std::string& urdf_path);

/// Links of the URDF that have a laser: by a ray sensor in <gazebo reference=...>, or by their
/// name. Those with a sensor first; of these that which looks ahead, by its x axis and "front" in
/// its name; then in the order of the model.
std::vector<std::string> LaserLinks(const Robot& robot, const std::string& urdf_xml);

}  // namespace hires::robot
