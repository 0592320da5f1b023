#include "nodes/odometry_filter/run.h"

#include <ros/ros.h>

#include "hires/ros/node/run_node.h"
#include "nodes/odometry_filter/odometry_filter_node.h"
#include "nodes/odometry_filter/odometry_filter_params.h"

namespace hires_ros {

int RunOdometryFilterNode(int argc, char** argv) {
  return RunNode("odometry_filter", argc, argv, [](ros::NodeHandle* nh) {
    const auto params = LoadOdometryFilterNodeParams();
    OdometryFilterNode node(params, nh);
    ros::spin();
  });
}

}  // namespace hires_ros
