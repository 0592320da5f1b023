#include "nodes/episode_recorder/run.h"

int main(int argc, char** argv) { return hires_ros::RunEpisodeRecorderNode(argc, argv); }
