#include "nodes/mapping/mapping_params.h"

#include <ros/package.h>

#include "hires/base/error.h"
#include "hires/base/param_reader.h"
#include "hires/ros/node/private_params.h"
#include "hires/ros/robot/load_robot_names.h"

namespace hires_ros {

MappingNodeParams LoadMappingNodeParams() {
  RejectUnknownPrivate({"config", "names", "map_file"});
  MappingNodeParams params;
  params.config = hires::mapping::ReadMappingConfig(hires::base::ParamReader::FromFile(
      PrivateText("config").value_or(ros::package::getPath("hires") + "/config/mapping.yaml")));
  params.names = LoadRobotNames();
  if (params.names.base_scan.empty()) {
    throw hires::base::ConfigError(
        "the names file has no base_scan; name there the topic of the base laser's LaserScan");
  }
  params.map_file = PrivateText("map_file").value_or("");
  return params;
}

}  // namespace hires_ros
