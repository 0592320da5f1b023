#pragma once

namespace hires_ros {

/// What the program `episode_recorder` does.  @returns the exit code
int RunEpisodeRecorderNode(int argc, char** argv);

}  // namespace hires_ros
