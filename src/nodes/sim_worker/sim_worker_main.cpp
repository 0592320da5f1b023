#include "nodes/sim_worker/run.h"

int main(int argc, char** argv) { return hires_ros::RunSimWorkerNode(argc, argv); }
