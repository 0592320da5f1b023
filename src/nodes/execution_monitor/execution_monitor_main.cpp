#include "nodes/execution_monitor/run.h"

int main(int argc, char** argv) { return hires_ros::RunExecutionMonitorNode(argc, argv); }
