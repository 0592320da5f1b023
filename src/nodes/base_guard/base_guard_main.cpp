#include <ros/ros.h>

#include "hires/ros/node/master_watch.h"
#include "hires/ros/node/run_node.h"
#include "nodes/base_guard/base_guard_node.h"

int main(int argc, char** argv) {
  return hires_ros::RunNode(
      "base_guard", argc, argv,
      [](ros::NodeHandle* nh) {
        hires_ros::BaseGuardNode node(hires_ros::LoadBaseGuardParams(), nh);
        node.Run(hires_ros::IsStopWanted);
      },
      hires_ros::OnStopSignal::kNote);
}
