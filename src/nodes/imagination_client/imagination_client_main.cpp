#include <ros/ros.h>

#include "hires/ros/node/run_node.h"
#include "nodes/imagination_client/imagination_client_node.h"

int main(int argc, char** argv) {
  return hires_ros::RunNode("imagination_client", argc, argv, [](ros::NodeHandle* nh) {
    const auto params = hires_ros::LoadImaginationClientParams();
    hires_ros::ImaginationClientNode node(
        params, hires::imagination::LoadImaginationSetup(params.setup), nh);
    ros::spin();
  });
}
