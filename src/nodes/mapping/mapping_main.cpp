#include <ros/ros.h>

#include "hires/ros/node/run_node.h"
#include "nodes/mapping/mapping_node.h"
#include "nodes/mapping/mapping_params.h"

int main(int argc, char** argv) {
  return hires_ros::RunNode("mapping", argc, argv, [](ros::NodeHandle* nh) {
    const auto params = hires_ros::LoadMappingNodeParams();
    hires_ros::MappingNode node(params, nh);
    ros::spin();
  });
}
