#include <ros/ros.h>

#include "hires/ros/node/run_node.h"
#include "nodes/localisation/localisation_node.h"
#include "nodes/localisation/localisation_params.h"

int main(int argc, char** argv) {
  return hires_ros::RunNode("localisation", argc, argv, [](ros::NodeHandle* nh) {
    const auto params = hires_ros::LoadLocalisationNodeParams();
    hires_ros::LocalisationNode node(params, nh);
    ros::spin();
  });
}
