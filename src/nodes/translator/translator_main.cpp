#include <ros/ros.h>

#include "hires/ros/node/run_node.h"
#include "hires/ros/translation/translator_params.h"
#include "nodes/translator/translator_node.h"

int main(int argc, char** argv) {
  return hires_ros::RunNode("translator", argc, argv, [](ros::NodeHandle* nh) {
    const auto params = hires_ros::LoadTranslatorParams();
    hires_ros::TranslatorNode node(hires_ros::LoadTranslatorContext(params), params.names.map_frame,
                                   nh);
    ros::spin();
  });
}
