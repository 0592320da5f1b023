#pragma once

namespace hires_ros {

/// What the program `worker_host` does.  @returns the exit code
int RunWorkerHostNode(int argc, char** argv);

}  // namespace hires_ros
