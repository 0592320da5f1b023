#include <ros/ros.h>

#include "hires/ros/node/run_node.h"
#include "nodes/world_tracker/world_tracker_node.h"
#include "nodes/world_tracker/world_tracker_params.h"

int main(int argc, char** argv) {
  return hires_ros::RunNode("world_tracker", argc, argv, [](ros::NodeHandle* nh) {
    const auto params = hires_ros::LoadWorldTrackerParams();
    hires_ros::WorldTrackerNode node(params, hires_ros::LoadTranslatorContext(params.files), nh);
    ros::spin();
  });
}
