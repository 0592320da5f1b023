#include "nodes/base_guard/run.h"

#include <ros/ros.h>

#include "hires/ros/node/master_watch.h"
#include "hires/ros/node/run_node.h"
#include "nodes/base_guard/base_guard_node.h"

namespace hires_ros {

int RunBaseGuardNode(int argc, char** argv) {
  return RunNode(
      "base_guard", argc, argv,
      [](ros::NodeHandle* nh) {
        BaseGuardNode node(LoadBaseGuardParams(), nh);
        node.Run(IsStopWanted);
      },
      OnStopSignal::kNote);
}

}  // namespace hires_ros
