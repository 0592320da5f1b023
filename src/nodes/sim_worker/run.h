#pragma once

namespace hires_ros {

/// What the program `sim_worker` does.  @returns the exit code
int RunSimWorkerNode(int argc, char** argv);

}  // namespace hires_ros
