#include "nodes/tabletop_recogniser/run.h"

#include <ros/ros.h>

#include "hires/ros/node/run_node.h"
#include "nodes/tabletop_recogniser/tabletop_recogniser_node.h"
#include "nodes/tabletop_recogniser/tabletop_recogniser_params.h"

namespace hires_ros {

int RunTabletopRecogniserNode(int argc, char** argv) {
  return RunNode("tabletop_recogniser", argc, argv, [](ros::NodeHandle* nh) {
    const auto params = LoadTabletopRecogniserParams();
    TabletopRecogniserNode node(params, nh);
    ros::spin();
  });
}

}  // namespace hires_ros
