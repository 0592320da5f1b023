#include "nodes/translator/run.h"

#include <ros/ros.h>

#include "hires/ros/node/run_node.h"
#include "hires/ros/translation/translator_params.h"
#include "nodes/translator/translator_node.h"

namespace hires_ros {

int RunTranslatorNode(int argc, char** argv) {
  return RunNode("translator", argc, argv, [](ros::NodeHandle* nh) {
    const auto params = LoadTranslatorParams();
    TranslatorNode node(LoadTranslatorContext(params), params.names.map_frame, nh);
    ros::spin();
  });
}

}  // namespace hires_ros
