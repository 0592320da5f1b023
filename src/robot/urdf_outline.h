#pragma once

#include <map>
#include <string>

namespace hires::robot {

/// What the XML of a URDF tells beside the parsed model.
struct UrdfOutline {
  std::map<std::string, int> link_lines;   ///< link name -> line in the file
  std::map<std::string, int> joint_lines;  ///< joint name -> line in the file
  std::map<std::string, double> friction;  ///< link name -> smaller of <gazebo>'s mu1 and mu2
};

/// Checks that the text is XML and that its links and joints form one tree, so that every such
/// error names a line; the URDF parser proper knows none. `where` stands for the file in messages.
/// @throws base::ConfigError: malformed XML, no <robot>, missing or repeated names, a joint without
/// parent or child, an unknown or twice-carried link, a loop, no root or several, friction < 0.
UrdfOutline ReadUrdfOutline(const std::string& xml, const std::string& where);

}  // namespace hires::robot
