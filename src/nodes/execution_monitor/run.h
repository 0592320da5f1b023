#pragma once

namespace hires_ros {

/// What the program `execution_monitor` does.  @returns the exit code
int RunExecutionMonitorNode(int argc, char** argv);

}  // namespace hires_ros
