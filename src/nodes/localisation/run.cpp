#include "nodes/localisation/run.h"

#include <ros/ros.h>

#include "hires/ros/node/run_node.h"
#include "nodes/localisation/localisation_node.h"
#include "nodes/localisation/localisation_params.h"

namespace hires_ros {

int RunLocalisationNode(int argc, char** argv) {
  return RunNode("localisation", argc, argv, [](ros::NodeHandle* nh) {
    const auto params = LoadLocalisationNodeParams();
    LocalisationNode node(params, nh);
    ros::spin();
  });
}

}  // namespace hires_ros
