#pragma once

namespace hires_ros {

/// What the program `relay` does.  @returns the exit code
int RunRelayNode(int argc, char** argv);

}  // namespace hires_ros
