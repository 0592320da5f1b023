#include "nodes/mapping/run.h"

#include <ros/ros.h>

#include "hires/ros/node/run_node.h"
#include "nodes/mapping/mapping_node.h"
#include "nodes/mapping/mapping_params.h"

namespace hires_ros {

int RunMappingNode(int argc, char** argv) {
  return RunNode("mapping", argc, argv, [](ros::NodeHandle* nh) {
    const auto params = LoadMappingNodeParams();
    MappingNode node(params, nh);
    ros::spin();
  });
}

}  // namespace hires_ros
