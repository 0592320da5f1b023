#include "nodes/heat_reader/run.h"

#include <ros/ros.h>

#include "hires/ros/node/run_node.h"
#include "nodes/heat_reader/heat_reader_node.h"
#include "nodes/heat_reader/heat_reader_params.h"

namespace hires_ros {

int RunHeatReaderNode(int argc, char** argv) {
  return RunNode("heat_reader", argc, argv, [](ros::NodeHandle* nh) {
    const auto params = LoadHeatReaderParams();
    HeatReaderNode node(params, nh);
    ros::spin();
  });
}

}  // namespace hires_ros
