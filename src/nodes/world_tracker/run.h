#pragma once

namespace hires_ros {

/// What the program `world_tracker` does.  @returns the exit code
int RunWorldTrackerNode(int argc, char** argv);

}  // namespace hires_ros
