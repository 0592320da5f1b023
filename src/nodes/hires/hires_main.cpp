#include "nodes/hires/run.h"

int main(int argc, char** argv) { return hires_ros::RunHiresNode(argc, argv); }
