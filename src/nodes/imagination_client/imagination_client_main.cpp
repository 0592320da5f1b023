#include "nodes/imagination_client/run.h"

int main(int argc, char** argv) { return hires_ros::RunImaginationClientNode(argc, argv); }
