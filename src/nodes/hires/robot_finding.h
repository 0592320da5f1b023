#pragma once

#include <string>
#include <vector>

#include "nodes/hires/ros_doctor.h"

namespace hires_ros {

struct RobotFinding {
  FindingLevel level{FindingLevel::kFailed};
  std::string code;     ///< one word for programs: "topic_missing"
  std::string subject;  ///< "topic /base_scan"
  std::string text;     ///< what is
  std::string remedy;   ///< what to do
};
using RobotFindings = std::vector<RobotFinding>;

}  // namespace hires_ros
