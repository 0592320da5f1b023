#include "nodes/planner/run.h"

#include <ros/ros.h>

#include "hires/ros/node/run_node.h"
#include "nodes/planner/planner_node.h"

namespace hires_ros {

int RunPlannerNode(int argc, char** argv) {
  return RunNode("planner", argc, argv, [](ros::NodeHandle* nh) {
    const auto config = LoadPlannerParams();
    PlannerNode node(config, hires::planning::LoadPlanningKnowledge(config), nh);
    ros::spin();
  });
}

}  // namespace hires_ros
