#include <ros/ros.h>

#include "hires/ros/node/run_node.h"
#include "nodes/planner/planner_node.h"

int main(int argc, char** argv) {
  return hires_ros::RunNode("planner", argc, argv, [](ros::NodeHandle* nh) {
    const auto config = hires_ros::LoadPlannerParams();
    hires_ros::PlannerNode node(config, hires::planning::LoadPlanningKnowledge(config), nh);
    ros::spin();
  });
}
