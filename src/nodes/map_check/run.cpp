#include "nodes/map_check/run.h"

#include <ros/ros.h>

#include <cstdlib>

#include "hires/base/error.h"
#include "hires/ros/master/xmlrpc_master_api.h"
#include "hires/ros/node/launch_guard.h"
#include "hires/ros/node/log_sink.h"
#include "hires/ros/node/master_watch.h"
#include "nodes/map_check/map_check_node.h"

namespace hires_ros {

int RunMapCheckNode(int argc, char** argv) {
  QuietXmlRpc();
  ros::init(argc, argv, "map_check", ros::init_options::NoSigintHandler);
  ShutDownRosOnSignals();
  ros::NodeHandle nh;
  MasterWatch master_watch;
  const ScopedLogSink log_sink;
  try {
    MapCheckNode node(LoadMapCheckParams(), &nh);
    const std::string misfit = node.Run();
    if (!misfit.empty()) {
      ROS_FATAL("map_check: %s", misfit.c_str());
      return EXIT_FAILURE;
    }
  } catch (const hires::base::ConfigError& error) {
    return EndMisconfigured("map_check", error);
  }
  return master_watch.Finish(EXIT_SUCCESS);
}

}  // namespace hires_ros
