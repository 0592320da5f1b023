#pragma once

#include <string>
#include <vector>

#include "hires/robot/robot_model.h"

namespace hires::robot {

/// A robot's model, and what is doubtful about it.
struct UrdfReading {
  RobotModel model;
  /// Meshes that are hardly in metres, a sentence each with file, size and remedy.
  std::vector<std::string> doubts;
  /// What is to be known of the base, where it is not the root of the file; see RootAtBase.
  std::string base_note{};
};

/// As ParseRobotModel, with what it would log of units.
UrdfReading ReadUrdf(const std::string& raw_xml, const std::string& where);

}  // namespace hires::robot
