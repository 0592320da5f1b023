#include "nodes/blackboard/run.h"

#include <ros/ros.h>

#include <cstdint>
#include <memory>

#include "hires/ros/node/run_node.h"
#include "nodes/blackboard/blackboard_node.h"

namespace hires_ros {

int RunBlackboardNode(int argc, char** argv) {
  return RunNode("blackboard", argc, argv, [](ros::NodeHandle* nh) {
    const auto config = LoadBlackboardParams();
    const auto ontology = std::make_shared<const hires::knowledge::Ontology>(
        hires::knowledge::Ontology::FromFiles(config.ontology));
    BlackboardNode node(config, ontology, nh);
    ros::AsyncSpinner spinner(static_cast<std::uint32_t>(config.threads));
    spinner.start();
    ros::waitForShutdown();
  });
}

}  // namespace hires_ros
