#pragma once

namespace hires_ros {

/// What the program `localisation` does.  @returns the exit code
int RunLocalisationNode(int argc, char** argv);

}  // namespace hires_ros
