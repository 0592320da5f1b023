#include <ros/ros.h>

#include "hires/ros/node/run_node.h"
#include "nodes/odometry_filter/odometry_filter_node.h"
#include "nodes/odometry_filter/odometry_filter_params.h"

int main(int argc, char** argv) {
  return hires_ros::RunNode("odometry_filter", argc, argv, [](ros::NodeHandle* nh) {
    const auto params = hires_ros::LoadOdometryFilterNodeParams();
    hires_ros::OdometryFilterNode node(params, nh);
    ros::spin();
  });
}
