#include <ros/ros.h>

#include "hires/base/error.h"
#include "hires/ros/node/launch_guard.h"
#include "hires/ros/node/log_sink.h"
#include "hires/ros/node/master_watch.h"
#include "nodes/worker_host/worker_host_node.h"

int main(int argc, char** argv) {
  hires::base::StopSignals signals;  // before any thread is made
  hires_ros::QuietXmlRpc();
  ros::init(argc, argv, "worker_host", ros::init_options::NoSigintHandler);
  if (!hires_ros::WaitForMainMaster(&signals)) return EXIT_SUCCESS;
  if (!hires_ros::ClaimName()) return EXIT_FAILURE;
  ros::NodeHandle nh;
  const hires_ros::ScopedLogSink log_sink;
  hires_ros::MasterWatch master_watch;
  try {
    hires_ros::WorkerHostNode node(hires_ros::LoadWorkerHostParams(), &nh);
    const int code = node.Run(&signals, master_watch);
    if (master_watch.silent_for() > 0.0) std::_Exit(code);  // or roscpp waits for it
    return master_watch.Finish(code);
  } catch (const hires::base::ConfigError& error) {
    return hires_ros::EndMisconfigured("worker_host", error);
  }
}
