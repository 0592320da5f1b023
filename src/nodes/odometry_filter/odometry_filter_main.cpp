#include "nodes/odometry_filter/run.h"

int main(int argc, char** argv) { return hires_ros::RunOdometryFilterNode(argc, argv); }
