#include <ros/ros.h>

#include <cstdint>
#include <memory>

#include "hires/ros/node/run_node.h"
#include "nodes/blackboard/blackboard_node.h"

int main(int argc, char** argv) {
  return hires_ros::RunNode("blackboard", argc, argv, [](ros::NodeHandle* nh) {
    const auto config = hires_ros::LoadBlackboardParams();
    const auto ontology = std::make_shared<const hires::knowledge::Ontology>(
        hires::knowledge::Ontology::FromFiles(config.ontology));
    hires_ros::BlackboardNode node(config, ontology, nh);
    ros::AsyncSpinner spinner(static_cast<std::uint32_t>(config.threads));
    spinner.start();
    ros::waitForShutdown();
  });
}
