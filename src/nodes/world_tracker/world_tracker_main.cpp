#include "nodes/world_tracker/run.h"

int main(int argc, char** argv) { return hires_ros::RunWorldTrackerNode(argc, argv); }
