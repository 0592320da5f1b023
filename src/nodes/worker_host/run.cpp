#include "nodes/worker_host/run.h"

#include <ros/ros.h>

#include "hires/base/error.h"
#include "hires/ros/node/launch_guard.h"
#include "hires/ros/node/log_sink.h"
#include "hires/ros/node/master_watch.h"
#include "nodes/worker_host/worker_host_node.h"

namespace hires_ros {

int RunWorkerHostNode(int argc, char** argv) {
  hires::base::StopSignals signals;  // before any thread is made
  QuietXmlRpc();
  ros::init(argc, argv, "worker_host", ros::init_options::NoSigintHandler);
  if (!WaitForMainMaster(&signals)) return EXIT_SUCCESS;
  if (!ClaimName()) return EXIT_FAILURE;
  ros::NodeHandle nh;
  const ScopedLogSink log_sink;
  MasterWatch master_watch;
  try {
    WorkerHostNode node(LoadWorkerHostParams(), &nh);
    const int code = node.Run(&signals, master_watch);
    if (master_watch.silent_for() > 0.0) std::_Exit(code);  // or roscpp waits for it
    return master_watch.Finish(code);
  } catch (const hires::base::ConfigError& error) {
    return EndMisconfigured("worker_host", error);
  }
}

}  // namespace hires_ros
