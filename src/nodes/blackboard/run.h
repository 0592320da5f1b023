#pragma once

namespace hires_ros {

/// What the program `blackboard` does.  @returns the exit code
int RunBlackboardNode(int argc, char** argv);

}  // namespace hires_ros
