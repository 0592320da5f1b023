#include <ros/ros.h>

#include <cstdlib>

#include "hires/base/error.h"
#include "hires/ros/master/xmlrpc_master_api.h"
#include "hires/ros/node/launch_guard.h"
#include "hires/ros/node/log_sink.h"
#include "hires/ros/node/master_watch.h"
#include "nodes/map_check/map_check_node.h"

int main(int argc, char** argv) {
  hires_ros::QuietXmlRpc();
  ros::init(argc, argv, "map_check", ros::init_options::NoSigintHandler);
  hires_ros::ShutDownRosOnSignals();
  ros::NodeHandle nh;
  hires_ros::MasterWatch master_watch;
  const hires_ros::ScopedLogSink log_sink;
  try {
    hires_ros::MapCheckNode node(hires_ros::LoadMapCheckParams(), &nh);
    const std::string misfit = node.Run();
    if (!misfit.empty()) {
      ROS_FATAL("map_check: %s", misfit.c_str());
      return EXIT_FAILURE;
    }
  } catch (const hires::base::ConfigError& error) {
    return hires_ros::EndMisconfigured("map_check", error);
  }
  return master_watch.Finish(EXIT_SUCCESS);
}
