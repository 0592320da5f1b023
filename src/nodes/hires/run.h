#pragma once

namespace hires_ros {

/// What the program `hires` does.  @returns the exit code
int RunHiresNode(int argc, char** argv);

}  // namespace hires_ros
