#pragma once

#include <memory>
#include <string>

#include "hires/control/robot_names.h"
#include "hires/perception/recogniser_config.h"
#include "hires/robot/robot_profile.h"

namespace hires_ros {

struct TabletopRecogniserParams {
  hires::perception::RecogniserConfig recogniser;    ///< config/recogniser.yaml
  std::shared_ptr<const hires::robot::Robot> robot;  ///< whose own parts are cut out
  std::string cloud;                                 ///< topic of sensor_msgs/PointCloud2
  std::string base_frame;                            ///< on the floor, its z axis up
};

/// From the private parameters config, robot, objects, names.
/// @throws hires::base::ConfigError naming file and key; also where the names file has no cloud.
TabletopRecogniserParams LoadTabletopRecogniserParams();

}  // namespace hires_ros
