#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "robot/urdf/told.h"
#include "robot/urdf/urdf_problems.h"

namespace hires::robot {

/// What the XML of a URDF tells beside the parsed model.
struct UrdfOutline {
  std::map<std::string, int> link_lines;   ///< link name -> line in the file
  std::map<std::string, int> joint_lines;  ///< joint name -> line in the file
  std::map<std::string, double> friction;  ///< by link: see base::ReadUrdfFriction

  std::vector<std::string> plugins;  ///< files of those in <gazebo>

  Told endless_friction;  ///< links with one that is infinite or negative: 1000

  // What is to be left out or put in for the rest to be read; empty if nothing is wrong.
  std::set<int> useless_links, useless_joints;  ///< the how manieth of its kind, from 0
  std::vector<std::string> roots;               ///< in order of names: all but the first are loose
};

constexpr int kMostLinks = 2000;       ///< of a robot, whose links are gone through again and again
constexpr int kMostShapes = 5000;      ///< of all its links
constexpr int kMostElements = 200000;  ///< of a URDF

/// Checks that the text is XML and that its links and joints form one tree, so that every such
/// error names a line; the URDF parser proper knows none. What is wrong goes to `problems`, with
/// what to leave out to read on: missing or repeated names, a joint without parent or child, an
/// unknown or twice-carried link, loops, several roots, friction < 0.
/// @param xml  plain: see base::PlainXml.
/// @throws base::ConfigError where nothing can be read on: malformed XML, no <robot>, no link, more
/// than the numbers above.
UrdfOutline ReadUrdfOutline(const std::string& xml, UrdfProblems* problems);

}  // namespace hires::robot
