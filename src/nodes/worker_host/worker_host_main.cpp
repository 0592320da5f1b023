#include "nodes/worker_host/run.h"

int main(int argc, char** argv) { return hires_ros::RunWorkerHostNode(argc, argv); }
