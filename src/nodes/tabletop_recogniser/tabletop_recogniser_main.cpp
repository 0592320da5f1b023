#include "nodes/tabletop_recogniser/run.h"

int main(int argc, char** argv) { return hires_ros::RunTabletopRecogniserNode(argc, argv); }
