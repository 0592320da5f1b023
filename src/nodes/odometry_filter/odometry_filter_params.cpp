#include "nodes/odometry_filter/odometry_filter_params.h"

#include <ros/package.h>

#include "hires/base/param_reader.h"
#include "hires/ros/node/private_params.h"
#include "hires/ros/robot/load_robot_names.h"

namespace hires_ros {

OdometryFilterNodeParams LoadOdometryFilterNodeParams() {
  RejectUnknownPrivate({"config", "names"});
  OdometryFilterNodeParams params;
  params.config = hires::localisation::ReadOdometryFilterConfig(
      hires::base::ParamReader::FromFile(PrivateText("config").value_or(
          ros::package::getPath("hires") + "/config/odometry_filter.yaml")));
  const hires::control::RobotNames names = LoadRobotNames();
  params.odometry_frame = names.odometry_frame;
  params.base_frame = names.base_frame;
  return params;
}

}  // namespace hires_ros
