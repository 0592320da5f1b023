#include "nodes/mapping/run.h"

int main(int argc, char** argv) { return hires_ros::RunMappingNode(argc, argv); }
