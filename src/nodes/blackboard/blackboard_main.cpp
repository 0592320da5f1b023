#include "nodes/blackboard/run.h"

int main(int argc, char** argv) { return hires_ros::RunBlackboardNode(argc, argv); }
