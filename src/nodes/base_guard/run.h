#pragma once

namespace hires_ros {

/// What the program `base_guard` does.  @returns the exit code
int RunBaseGuardNode(int argc, char** argv);

}  // namespace hires_ros
