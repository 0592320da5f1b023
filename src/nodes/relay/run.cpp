#include "nodes/relay/run.h"

#include <ros/ros.h>

#include "hires/base/error.h"
#include "hires/ros/node/launch_guard.h"
#include "hires/ros/node/log_sink.h"
#include "hires/ros/node/master_watch.h"
#include "nodes/relay/relay_node.h"

namespace hires_ros {

int RunRelayNode(int argc, char** argv) {
  QuietXmlRpc();
  ros::init(argc, argv, "relay");
  ShutDownRosOnSignals();
  ros::NodeHandle nh;
  const ScopedLogSink log_sink;
  MasterWatch master_watch;
  try {
    RelayNode node(LoadRelayParams(), &nh);
    node.Run(master_watch);
    if (master_watch.silent_for() > 0.0) std::_Exit(EXIT_SUCCESS);  // or roscpp waits for it
  } catch (const hires::base::ConfigError& error) {
    return EndMisconfigured("relay", error);
  }
  return master_watch.Finish(EXIT_SUCCESS);
}

}  // namespace hires_ros
