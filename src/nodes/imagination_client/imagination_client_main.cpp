#include <ros/ros.h>

#include <cstdlib>

#include "hires/base/error.h"
#include "hires/ros/log_sink.h"
#include "hires/ros/master_watch.h"
#include "hires/ros/xmlrpc_master_api.h"
#include "nodes/imagination_client/imagination_client_node.h"

int main(int argc, char** argv) {
  hires_ros::QuietXmlRpc();
  ros::init(argc, argv, "imagination_client", ros::init_options::NoSigintHandler);
  hires_ros::ShutDownRosOnSignals();
  ros::NodeHandle nh;
  hires_ros::MasterWatch master_watch;
  const hires_ros::ScopedLogSink log_sink;
  try {
    const auto params = hires_ros::LoadImaginationClientParams();
    hires_ros::ImaginationClientNode node(
        params, hires::imagination::LoadImaginationSetup(params.setup), &nh);
    ros::spin();
  } catch (const hires::base::ConfigError& error) {
    ROS_FATAL("imagination_client: %s", error.what());
    return EXIT_FAILURE;
  }
  return master_watch.Finish(EXIT_SUCCESS);
}
