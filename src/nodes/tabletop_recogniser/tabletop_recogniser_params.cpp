#include "nodes/tabletop_recogniser/tabletop_recogniser_params.h"

#include <ros/package.h>

#include "hires/base/error.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/robot/load_robot.h"
#include "hires/ros/node/private_params.h"
#include "hires/ros/robot/load_robot_names.h"

namespace hires_ros {

TabletopRecogniserParams LoadTabletopRecogniserParams() {
  RejectUnknownPrivate({"config", "robot", "objects", "names"});
  const std::string folder = ros::package::getPath("hires") + "/config/";
  auto scene = hires::imagination::ReadSetupConfig(folder + "scene.yaml");
  hires::imagination::OverridePaths({}, PrivateText("robot"), {}, {}, &scene);
  TabletopRecogniserParams params;
  params.recogniser = hires::perception::ReadRecogniserConfig(
      PrivateText("config").value_or(folder + "recogniser.yaml"),
      PrivateText("objects").value_or(""));
  params.robot =
      std::make_shared<const hires::robot::Robot>(hires::robot::LoadAnyRobot(scene.robot));
  const hires::control::RobotNames names = LoadRobotNames();
  params.cloud = names.sensors.depth_cloud;
  params.base_frame = names.base_frame;
  if (params.cloud.empty()) {
    throw hires::base::ConfigError(
        "the names file has no sensors/depth_cloud; name there the topic of the depth camera's "
        "PointCloud2");
  }
  return params;
}

}  // namespace hires_ros
