#pragma once

#include <string>
#include <vector>

#include "hires/imagination/imagination_setup.h"

namespace hires::imagination {

/// Reads places to stand at out of a YAML file of goals or waypoints as navigation tools have them,
/// in lists or by name, under whatever keys:
/// - [x, y], [x, y, yaw] or [x, y, z, qx, qy, qz, qw], also as text or after a name;
/// - {x, y} (or px, position_x, ...) with yaw, theta, th, heading, angle, rz or phi [rad], with
///   yaw_deg [degrees], with rpy or euler, or with a quaternion: qz and qw, or z and w of length 1;
/// - {position, orientation} of geometry_msgs, in maps or lists (x, y, z, w), with a header or
///   without, below pose, target_pose and the like; several documents as `rostopic echo` prints
///   them; `location`, `coords`, `pos` and the like beside a name, a yaw or an orientation;
/// - lists side by side: goals_x, goals_y, goals_yaw;
/// - {pose: [x, y, z], orientation: [w, x, y, z]}, as the panel of Nav2 for RViz saves them; or
///   all with x, y, z, w, where that is the one order in which they turn about z;
/// - [[x, y, z], [x, y, z, w]] or [[x, y, 0], [0, 0, yaw]] below a name.
/// `angle_unit: degrees` (yaw_unit, units, in_degrees) holds for what it stands beside and what
/// lies in that. Case is ignored in keys. Names are those of the keys, or of `name`, `id`, `label`,
/// `room` and the like beside a pose; others are called goal1, goal2, ... by their number in the
/// file. A goal that comes again with the same name and pose is kept once. What is assumed (no yaw:
/// 0), hardly used (heights: NamedArea::z) or passed over (keys that say nothing of a goal, or hold
/// none by their names: tolerances, colors, sizes; numbers of which no goal could be made) is
/// logged once for each kind, with the first place.
/// @throws base::ConfigError with all that is wrong, each with its line: also frames that drift or
/// move (odom, base_link, with or without a robot's name before), and quaternions that are none.
std::vector<NamedArea> ReadAreaFile(const std::string& path);

}  // namespace hires::imagination
