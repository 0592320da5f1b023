#pragma once

#include <map>
#include <string>
#include <vector>

#include "robot/urdf/urdf_problems.h"
#include "robot/urdf_outline.h"

namespace hires::robot {

/// A URDF as the parser gets it.
struct CleanUrdf {
  std::string xml;
  /// Of each link, the lines of its collision shapes in the file, in the parser's order.
  std::map<std::string, std::vector<int>> shape_lines;
};

/// Whether what CleanedUrdf makes has such elements of a "robot", "link" or "joint"; all of them
/// that lie deeper, too.
bool IsKept(const std::string& parent, const std::string& child);

/// Leaves out what no question here needs and the parser would refuse a robot for: looks,
/// transmissions, plugins, sensors, calibration, masses and inertias that no body can have,
/// collisions without a shape or with a point or a line for one. Joints that float or move in a
/// plane are fixed, as the base moves by itself, and so are those whose axis is no direction; those
/// without limits that need some, or with words for them, are held at 0; limits in the wrong order
/// are swapped, infinite ones are 1e16, and what may turn by 1000 rad to both sides is continuous;
/// efforts and velocities that are not said, or are no numbers of at least 0, are 0. A capsule
/// (`<capsule radius length>`, the length that of its straight part) becomes a cylinder and two
/// spheres. Logs a warning for each kind of what is wrong, with all names, lines and number.
/// What is wrong (numbers that are none, unknown shapes and kinds of joints) goes to `problems`,
/// and something that can be read takes its place, so that the rest is judged, too.
/// @param xml  a plain URDF (see base::PlainXml) that ReadUrdfOutline can read, and `outline` what
/// it says.
/// @param where  the file, for messages.
CleanUrdf CleanedUrdf(const std::string& xml, const UrdfOutline& outline, const std::string& where,
                      UrdfProblems* problems);

}  // namespace hires::robot
