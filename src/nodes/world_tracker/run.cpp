#include "nodes/world_tracker/run.h"

#include <ros/ros.h>

#include "hires/ros/node/run_node.h"
#include "nodes/world_tracker/world_tracker_node.h"
#include "nodes/world_tracker/world_tracker_params.h"

namespace hires_ros {

int RunWorldTrackerNode(int argc, char** argv) {
  return RunNode("world_tracker", argc, argv, [](ros::NodeHandle* nh) {
    const auto params = LoadWorldTrackerParams();
    WorldTrackerNode node(params, LoadTranslatorContext(params.files), nh);
    ros::spin();
  });
}

}  // namespace hires_ros
