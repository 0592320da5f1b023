#include "nodes/topple_monitor/topple_monitor_params.h"

#include <ros/package.h>

#include "hires/base/error.h"
#include "hires/base/local_time.h"
#include "hires/base/param_reader.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/robot/load_robot.h"
#include "hires/ros/node/private_params.h"

namespace hires_ros {
namespace {

using hires::base::ParamReader;

std::string NonEmpty(ParamReader* in, const std::string& key) {
  const std::string topic = in->GetString(key);
  if (topic.empty()) in->Fail(key, "is empty, wanted a topic");
  return topic;
}

}  // namespace

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

  ParamReader in =
      ParamReader::FromFile(PrivateText("config").value_or(folder + "topple_monitor.yaml"));
  params.world_topic = NonEmpty(&in, "world_state");
  params.robot_topic = NonEmpty(&in, "robot_state");
  params.follower.object = in.GetString("object");
  params.follower.after_fall = in.Get("after_fall", hires::base::Between(0.0, 3600.0));
  in.RejectUnknownKeys();

  auto scene = hires::imagination::ReadSetupConfig(folder + "scene.yaml");
  hires::imagination::OverridePaths({}, PrivateText("robot"), {}, {}, &scene);
  params.rollout = scene.rollout;
  params.robot = hires::robot::LoadAnyRobot(scene.robot);
  return params;
}

}  // namespace hires_ros
