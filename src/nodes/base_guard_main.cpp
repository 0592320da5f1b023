#include <ros/ros.h>

#include <csignal>
#include <cstdlib>

#include "hires/base/error.h"
#include "hires/ros/base_guard_node.h"
#include "hires/ros/log_sink.h"
#include "hires/ros/master_watch.h"
#include "hires/ros/xmlrpc_master_api.h"

namespace {

volatile std::sig_atomic_t stop_wanted = 0;

void WantStop(int) { stop_wanted = 1; }

}  // namespace

int main(int argc, char** argv) {
  hires_ros::QuietXmlRpc();
  ros::init(argc, argv, "base_guard", ros::init_options::NoSigintHandler);
  // ROS must live on until the base stands: not hires_ros::ShutDownRosOnSignals().
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, WantStop);
  ros::NodeHandle nh;
  hires_ros::MasterWatch master_watch;
  const hires_ros::ScopedLogSink log_sink;
  try {
    hires_ros::BaseGuardNode node(hires_ros::LoadBaseGuardParams(), &nh);
    node.Run([] { return stop_wanted != 0; });
  } catch (const hires::base::ConfigError& error) {
    ROS_FATAL("base_guard: %s", error.what());
    return EXIT_FAILURE;
  }
  return master_watch.Finish(EXIT_SUCCESS);
}
