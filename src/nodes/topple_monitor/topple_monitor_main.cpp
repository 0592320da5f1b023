#include "nodes/topple_monitor/run.h"

int main(int argc, char** argv) { return hires_ros::RunToppleMonitorNode(argc, argv); }
