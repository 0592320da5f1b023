#include "nodes/topple_monitor/topple_monitor_params.h"

#include <ros/package.h>

#include "hires/base/error.h"
#include "hires/base/local_time.h"
#include "hires/base/param_reader.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/robot/load_robot.h"
#include "hires/ros/node/private_params.h"

namespace hires_ros {

ToppleMonitorParams LoadToppleMonitorParams() {
  RejectUnknownPrivate({"config", "robot", "store", "run"});
  const std::string folder = ros::package::getPath("hires") + "/config/";
  ToppleMonitorParams params;
  params.store = PrivateText("store").value_or("");
  if (params.store.empty()) {
    throw hires::base::ConfigError(
        "~store is missing; wanted the file that the experiences shall stand in, new or with "
        "earlier ones");
  }
  params.run = PrivateText("run").value_or("");
  if (params.run.empty()) params.run = hires::base::LocalTime();

  params.config = hires::reports::ReadToppleMonitorConfig(hires::base::ParamReader::FromFile(
      PrivateText("config").value_or(folder + "topple_monitor.yaml")));

  auto scene = hires::imagination::ReadSetupConfig(folder + "scene.yaml");
  hires::imagination::OverridePaths({}, PrivateText("robot"), {}, {}, &scene);
  params.rollout = scene.rollout;
  params.robot = hires::robot::LoadAnyRobot(scene.robot);
  return params;
}

}  // namespace hires_ros
