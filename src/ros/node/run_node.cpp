#include "hires/ros/node/run_node.h"

#include <ros/exceptions.h>
#include <ros/init.h>

#include <cstdlib>

#include "hires/base/error.h"
#include "hires/ros/master/xmlrpc_master_api.h"
#include "hires/ros/node/launch_guard.h"
#include "hires/ros/node/log_sink.h"
#include "hires/ros/node/master_watch.h"

namespace hires_ros {

int RunNode(const std::string& name, int argc, char** argv,
            const std::function<void(ros::NodeHandle*)>& play, OnStopSignal on_stop) {
  QuietXmlRpc();
  ros::init(argc, argv, name, ros::init_options::NoSigintHandler);
  if (on_stop == OnStopSignal::kNote) {
    NoteStopSignals();
  } else {
    ShutDownRosOnSignals();
  }
  if (!ClaimName()) return EXIT_FAILURE;
  ros::NodeHandle nh;
  MasterWatch master_watch;
  const ScopedLogSink log_sink;
  try {
    play(&nh);
  } catch (const hires::base::ConfigError& error) {
    return EndMisconfigured(name, error);
  } catch (
      const ros::InvalidNameException& error) {  // of a topic or server, by a file or parameter
    return EndMisconfigured(name, hires::base::ConfigError(error.what()));
  }
  return master_watch.Finish(EXIT_SUCCESS);
}

}  // namespace hires_ros
