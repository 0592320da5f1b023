#include <ros/ros.h>

#include "hires/base/error.h"
#include "hires/ros/node/log_sink.h"
#include "hires/ros/node/master_watch.h"
#include "nodes/relay/relay_node.h"

int main(int argc, char** argv) {
  hires_ros::QuietXmlRpc();
  ros::init(argc, argv, "relay");
  hires_ros::ShutDownRosOnSignals();
  ros::NodeHandle nh;
  const hires_ros::ScopedLogSink log_sink;
  hires_ros::MasterWatch master_watch;
  try {
    hires_ros::RelayNode node(hires_ros::LoadRelayParams(), &nh);
    node.Run(master_watch);
    if (master_watch.silent_for() > 0.0) std::_Exit(EXIT_SUCCESS);  // or roscpp waits for it
  } catch (const hires::base::ConfigError& error) {
    ROS_FATAL("relay: %s", error.what());
    return EXIT_FAILURE;
  }
  return master_watch.Finish(EXIT_SUCCESS);
}
