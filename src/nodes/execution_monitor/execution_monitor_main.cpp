#include <ros/ros.h>

#include "hires/ros/node/run_node.h"
#include "nodes/execution_monitor/execution_monitor_node.h"

int main(int argc, char** argv) {
  return hires_ros::RunNode("execution_monitor", argc, argv, [](ros::NodeHandle* nh) {
    const auto config = hires_ros::LoadExecutionMonitorParams();
    const auto knowledge = hires_ros::LoadExecutionKnowledge(config);
    hires_ros::ExecutionMonitorNode node(config, knowledge, nh);
    ros::spin();
  });
}
