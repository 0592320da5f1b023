#include "nodes/middle_layer/run.h"

#include <ros/ros.h>

#include "hires/ros/node/master_watch.h"
#include "hires/ros/node/run_node.h"
#include "nodes/middle_layer/middle_layer_node.h"

namespace hires_ros {

int RunMiddleLayerNode(int argc, char** argv) {
  return RunNode(
      "middle_layer", argc, argv,
      [](ros::NodeHandle* nh) {
        const auto params = LoadMiddleLayerParams();
        MiddleLayerNode node(params, hires::imagination::LoadImaginationSetup(params.setup), nh);
        node.Run(IsStopWanted);
      },
      OnStopSignal::kNote);
}

}  // namespace hires_ros
