#include <ros/ros.h>

#include <cstdlib>

#include "hires/base/error.h"
#include "hires/ros/launch_guard.h"
#include "hires/ros/log_sink.h"
#include "hires/ros/master_watch.h"
#include "hires/ros/xmlrpc_master_api.h"
#include "nodes/mapping/mapping_node.h"
#include "nodes/mapping/mapping_params.h"

int main(int argc, char** argv) {
  hires_ros::QuietXmlRpc();
  ros::init(argc, argv, "mapping", ros::init_options::NoSigintHandler);
  hires_ros::ShutDownRosOnSignals();
  if (!hires_ros::ClaimName()) return EXIT_FAILURE;
  ros::NodeHandle nh;
  hires_ros::MasterWatch master_watch;
  const hires_ros::ScopedLogSink log_sink;
  try {
    const auto params = hires_ros::LoadMappingNodeParams();
    hires_ros::MappingNode node(params, &nh);
    ros::spin();
  } catch (const hires::base::ConfigError& error) {
    return hires_ros::EndMisconfigured("mapping", error);
  }
  return master_watch.Finish(EXIT_SUCCESS);
}
