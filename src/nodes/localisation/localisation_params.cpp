#include "nodes/localisation/localisation_params.h"

#include <ros/package.h>

#include "hires/base/error.h"
#include "hires/base/param_reader.h"
#include "hires/ros/load_robot_names.h"
#include "hires/ros/node/private_params.h"

namespace hires_ros {

LocalisationNodeParams LoadLocalisationNodeParams() {
  RejectUnknownPrivate({"config", "names", "seed"});
  LocalisationNodeParams params;
  params.config = hires::localisation::ReadLocalisationConfig(
      hires::base::ParamReader::FromFile(PrivateText("config").value_or(
          ros::package::getPath("hires") + "/config/localisation.yaml")));
  params.names = LoadRobotNames();
  if (params.names.base_scan.empty()) {
    throw hires::base::ConfigError(
        "the names file has no base_scan; name there the topic of the base laser's LaserScan");
  }
  int seed = 1;
  Override("seed", PrivateInt("seed"), hires::base::Between(0, 2147483647), &seed);
  params.seed = static_cast<std::uint64_t>(seed);
  return params;
}

}  // namespace hires_ros
