#include <ros/ros.h>

#include "hires/ros/node/master_watch.h"
#include "hires/ros/node/run_node.h"
#include "nodes/middle_layer/middle_layer_node.h"

int main(int argc, char** argv) {
  return hires_ros::RunNode(
      "middle_layer", argc, argv,
      [](ros::NodeHandle* nh) {
        const auto params = hires_ros::LoadMiddleLayerParams();
        hires_ros::MiddleLayerNode node(params,
                                        hires::imagination::LoadImaginationSetup(params.setup), nh);
        node.Run(hires_ros::IsStopWanted);
      },
      hires_ros::OnStopSignal::kNote);
}
