#pragma once

namespace hires_ros {

/// What the program `heat_reader` does.  @returns the exit code
int RunHeatReaderNode(int argc, char** argv);

}  // namespace hires_ros
