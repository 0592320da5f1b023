#include <ros/ros.h>

#include "hires/ros/node/run_node.h"
#include "nodes/tabletop_recogniser/tabletop_recogniser_node.h"
#include "nodes/tabletop_recogniser/tabletop_recogniser_params.h"

int main(int argc, char** argv) {
  return hires_ros::RunNode("tabletop_recogniser", argc, argv, [](ros::NodeHandle* nh) {
    const auto params = hires_ros::LoadTabletopRecogniserParams();
    hires_ros::TabletopRecogniserNode node(params, nh);
    ros::spin();
  });
}
