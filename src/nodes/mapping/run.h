#pragma once

namespace hires_ros {

/// What the program `mapping` does.  @returns the exit code
int RunMappingNode(int argc, char** argv);

}  // namespace hires_ros
