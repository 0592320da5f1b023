#include "nodes/relay/run.h"

int main(int argc, char** argv) { return hires_ros::RunRelayNode(argc, argv); }
