#pragma once

namespace hires_ros {

/// What the program `map_check` does.  @returns the exit code
int RunMapCheckNode(int argc, char** argv);

}  // namespace hires_ros
