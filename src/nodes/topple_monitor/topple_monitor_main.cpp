#include <ros/ros.h>

#include "hires/ros/node/run_node.h"
#include "nodes/topple_monitor/topple_monitor_node.h"
#include "nodes/topple_monitor/topple_monitor_params.h"

int main(int argc, char** argv) {
  return hires_ros::RunNode("topple_monitor", argc, argv, [](ros::NodeHandle* nh) {
    hires_ros::ToppleMonitorNode node(hires_ros::LoadToppleMonitorParams(), nh);
    ros::spin();
  });
}
