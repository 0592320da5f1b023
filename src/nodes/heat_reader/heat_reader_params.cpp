#include "nodes/heat_reader/heat_reader_params.h"

#include <ros/package.h>

#include "hires/base/error.h"
#include "hires/base/param_reader.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/robot/load_robot.h"
#include "hires/ros/node/private_params.h"
#include "hires/ros/robot/load_robot_names.h"
#include "hires/translation/translator.h"
#include "hires/world/object_catalogue.h"

namespace hires_ros {

HeatReaderParams LoadHeatReaderParams() {
  RejectUnknownPrivate({"config", "world", "robot", "objects", "names", "map_to_world"});
  const std::string folder = ros::package::getPath("hires") + "/config/";
  auto scene = hires::imagination::ReadSetupConfig(folder + "scene.yaml");
  hires::imagination::OverridePaths(PrivateText("world"), PrivateText("robot"),
                                    PrivateText("objects"), {}, &scene);
  HeatReaderParams params;
  params.warm = hires::perception::ReadWarmParams(hires::base::ParamReader::FromFile(
      PrivateText("config").value_or(folder + "heat_reader.yaml")));
  params.names = LoadRobotNames();
  if (params.names.sensors.thermal_image.empty() || params.names.sensors.thermal_info.empty()) {
    throw hires::base::ConfigError(
        "the names file lacks sensors/thermal_image or sensors/thermal_info; name there the topics "
        "of the thermal camera's Image and CameraInfo");
  }
  const auto context = hires::translation::MakeContext(
      hires::world::LoadWorld(scene.world), hires::robot::LoadAnyRobot(scene.robot),
      hires::world::LoadCatalogueModels(scene.objects), nullptr);
  params.robot = context.robot;
  params.world = context.world;
  return params;
}

}  // namespace hires_ros
