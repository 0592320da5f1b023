#include "nodes/middle_layer/run.h"

int main(int argc, char** argv) { return hires_ros::RunMiddleLayerNode(argc, argv); }
