#include "hires/ros/robot/load_robot_names.h"

#include <ros/package.h>

#include "hires/geometry/map_to_world.h"
#include "hires/ros/node/private_params.h"

namespace hires_ros {

using hires::control::ReadRobotNames;
using hires::control::RobotNames;

RobotNames LoadRobotNames() {
  const auto path = PrivateText("names");
  RobotNames names = ReadRobotNames(path && !path->empty() ? *path
                                                           : ros::package::getPath("hires") +
                                                                 "/config/robots/pr2_names.yaml");
  names.map_to_world =
      hires::geometry::ParseMapToWorld(PrivateText("map_to_world").value_or(""), "~map_to_world");
  return names;
}

}  // namespace hires_ros
