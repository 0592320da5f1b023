#include "nodes/execution_monitor/run.h"

#include <ros/ros.h>

#include "hires/ros/node/run_node.h"
#include "nodes/execution_monitor/execution_monitor_node.h"

namespace hires_ros {

int RunExecutionMonitorNode(int argc, char** argv) {
  return RunNode("execution_monitor", argc, argv, [](ros::NodeHandle* nh) {
    auto config = LoadExecutionMonitorParams();
    const auto knowledge = LoadExecutionKnowledge(config);
    LoadDefaults(knowledge.operators, &config);
    ExecutionMonitorNode node(config, knowledge, nh);
    ros::spin();
  });
}

}  // namespace hires_ros
