#include <ros/ros.h>

#include <cstdlib>

#include "hires/base/error.h"
#include "hires/base/process.h"
#include "hires/ros/launch_guard.h"
#include "hires/ros/log_sink.h"
#include "hires/ros/master_watch.h"
#include "hires/ros/xmlrpc_master_api.h"
#include "nodes/blackboard/blackboard_node.h"

int main(int argc, char** argv) {
  hires_ros::QuietXmlRpc();
  ros::init(argc, argv, "blackboard", ros::init_options::NoSigintHandler);
  hires_ros::ShutDownRosOnSignals();
  if (!hires_ros::ClaimName()) return EXIT_FAILURE;
  ros::NodeHandle nh;
  hires_ros::MasterWatch master_watch;
  const hires_ros::ScopedLogSink log_sink;
  try {
    const auto config = hires_ros::LoadBlackboardParams();
    const auto ontology = std::make_shared<const hires::knowledge::Ontology>(
        hires::knowledge::Ontology::FromFiles(config.ontology));
    hires_ros::BlackboardNode node(config, ontology, &nh);
    ros::AsyncSpinner spinner(static_cast<std::uint32_t>(config.threads));
    spinner.start();
    ros::waitForShutdown();
  } catch (const hires::base::ConfigError& error) {
    return hires_ros::EndMisconfigured("blackboard", error);
  }
  return master_watch.Finish(EXIT_SUCCESS);
}
