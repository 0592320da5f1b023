#include "nodes/base_guard/run.h"

int main(int argc, char** argv) { return hires_ros::RunBaseGuardNode(argc, argv); }
