#include "nodes/localisation/run.h"

int main(int argc, char** argv) { return hires_ros::RunLocalisationNode(argc, argv); }
