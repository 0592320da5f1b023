#include "nodes/translator/run.h"

int main(int argc, char** argv) { return hires_ros::RunTranslatorNode(argc, argv); }
