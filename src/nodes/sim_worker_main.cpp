#include <ros/ros.h>

#include <cstdlib>

#include "hires/base/error.h"
#include "hires/ros/log_sink.h"
#include "hires/ros/master_watch.h"
#include "hires/ros/sim_worker_node.h"
#include "hires/ros/xmlrpc_master_api.h"

int main(int argc, char** argv) {
  hires_ros::QuietXmlRpc();
  ros::init(argc, argv, "sim_worker", ros::init_options::NoSigintHandler);
  hires_ros::ShutDownRosOnSignals();
  ros::NodeHandle nh;
  const hires_ros::ScopedLogSink log_sink;
  try {
    const hires_ros::SimWorkerParams params = hires_ros::LoadSimWorkerParams();
    hires_ros::SimWorkerNode node(params, hires::imagination::LoadImaginationSetup(params.setup),
                                  &nh);
    ros::spin();
  } catch (const hires::base::ConfigError& error) {
    ROS_FATAL("sim_worker: %s", error.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
