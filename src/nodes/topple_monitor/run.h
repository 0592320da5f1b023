#pragma once

namespace hires_ros {

/// What the program `topple_monitor` does.  @returns the exit code
int RunToppleMonitorNode(int argc, char** argv);

}  // namespace hires_ros
