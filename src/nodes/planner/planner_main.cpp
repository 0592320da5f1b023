#include "nodes/planner/run.h"

int main(int argc, char** argv) { return hires_ros::RunPlannerNode(argc, argv); }
