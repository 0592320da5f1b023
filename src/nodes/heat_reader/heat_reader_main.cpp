#include "nodes/heat_reader/run.h"

int main(int argc, char** argv) { return hires_ros::RunHeatReaderNode(argc, argv); }
