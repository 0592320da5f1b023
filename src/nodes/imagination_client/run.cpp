#include "nodes/imagination_client/run.h"

#include <ros/ros.h>

#include "hires/ros/node/run_node.h"
#include "nodes/imagination_client/imagination_client_node.h"

namespace hires_ros {

int RunImaginationClientNode(int argc, char** argv) {
  return RunNode("imagination_client", argc, argv, [](ros::NodeHandle* nh) {
    const auto params = LoadImaginationClientParams();
    ImaginationClientNode node(params, hires::imagination::LoadImaginationSetup(params.setup), nh);
    ros::spin();
  });
}

}  // namespace hires_ros
