#include <ros/ros.h>

#include "hires/ros/node/run_node.h"
#include "nodes/heat_reader/heat_reader_node.h"
#include "nodes/heat_reader/heat_reader_params.h"

int main(int argc, char** argv) {
  return hires_ros::RunNode("heat_reader", argc, argv, [](ros::NodeHandle* nh) {
    const auto params = hires_ros::LoadHeatReaderParams();
    hires_ros::HeatReaderNode node(params, nh);
    ros::spin();
  });
}
