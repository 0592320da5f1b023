#include "nodes/episode_recorder/run.h"

#include <ros/ros.h>

#include <cstdlib>

#include "hires/base/error.h"
#include "hires/ros/master/xmlrpc_master_api.h"
#include "hires/ros/node/launch_guard.h"
#include "hires/ros/node/log_sink.h"
#include "hires/ros/node/master_watch.h"
#include "nodes/episode_recorder/episode_recorder_node.h"

namespace hires_ros {

int RunEpisodeRecorderNode(int argc, char** argv) {
  QuietXmlRpc();
  ros::init(argc, argv, "episode_recorder", ros::init_options::NoSigintHandler);
  ShutDownRosOnSignals();
  if (!ClaimName()) return EXIT_FAILURE;
  ros::NodeHandle nh;
  MasterWatch master_watch;
  const ScopedLogSink log_sink;
  try {
    EpisodeRecorderNode node(LoadEpisodeRecorderParams(), &nh);
    ros::spin();
  } catch (const hires::base::ConfigError& error) {
    return EndMisconfigured("episode_recorder", error);
  } catch (const rosbag::BagException& error) {
    ROS_FATAL("episode_recorder: the bag cannot be written (%s); is the disk full?", error.what());
    return EXIT_FAILURE;
  }
  return master_watch.Finish(EXIT_SUCCESS);
}

}  // namespace hires_ros
