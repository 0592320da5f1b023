#include "nodes/hires/remote_server.h"

#include <fmt/format.h>
#include <ros/master.h>

#include "hires/base/error.h"

namespace hires_ros {

void RequireMaster(const std::string& launch_file, const std::string& otherwise) {
  if (ros::master::check()) return;
  throw hires::base::ConfigError(fmt::format(
      "no ROS master answers at {}; start one (roslaunch hires {}){} set ROS_MASTER_URI{}",
      ros::master::getURI(), launch_file, otherwise.empty() ? ", or" : ",",
      otherwise.empty() ? "" : ", or " + otherwise));
}

}  // namespace hires_ros
