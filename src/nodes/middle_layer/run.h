#pragma once

namespace hires_ros {

/// What the program `middle_layer` does.  @returns the exit code
int RunMiddleLayerNode(int argc, char** argv);

}  // namespace hires_ros
