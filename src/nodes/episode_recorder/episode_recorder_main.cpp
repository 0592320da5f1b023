#include <ros/ros.h>

#include <cstdlib>

#include "hires/base/error.h"
#include "hires/ros/master/xmlrpc_master_api.h"
#include "hires/ros/node/launch_guard.h"
#include "hires/ros/node/log_sink.h"
#include "hires/ros/node/master_watch.h"
#include "nodes/episode_recorder/episode_recorder_node.h"

int main(int argc, char** argv) {
  hires_ros::QuietXmlRpc();
  ros::init(argc, argv, "episode_recorder", ros::init_options::NoSigintHandler);
  hires_ros::ShutDownRosOnSignals();
  if (!hires_ros::ClaimName()) return EXIT_FAILURE;
  ros::NodeHandle nh;
  hires_ros::MasterWatch master_watch;
  const hires_ros::ScopedLogSink log_sink;
  try {
    hires_ros::EpisodeRecorderNode node(hires_ros::LoadEpisodeRecorderParams(), &nh);
    ros::spin();
  } catch (const hires::base::ConfigError& error) {
    return hires_ros::EndMisconfigured("episode_recorder", error);
  } catch (const rosbag::BagException& error) {
    ROS_FATAL("episode_recorder: the bag cannot be written (%s); is the disk full?", error.what());
    return EXIT_FAILURE;
  }
  return master_watch.Finish(EXIT_SUCCESS);
}
