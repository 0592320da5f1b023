#include "nodes/topple_monitor/run.h"

#include <ros/ros.h>

#include "hires/ros/node/run_node.h"
#include "nodes/topple_monitor/topple_monitor_node.h"
#include "nodes/topple_monitor/topple_monitor_params.h"

namespace hires_ros {

int RunToppleMonitorNode(int argc, char** argv) {
  return RunNode("topple_monitor", argc, argv, [](ros::NodeHandle* nh) {
    ToppleMonitorNode node(LoadToppleMonitorParams(), nh);
    ros::spin();
  });
}

}  // namespace hires_ros
