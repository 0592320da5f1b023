#include "nodes/map_check/run.h"

int main(int argc, char** argv) { return hires_ros::RunMapCheckNode(argc, argv); }
