#pragma once

namespace hires_ros {

/// What the program `tabletop_recogniser` does.  @returns the exit code
int RunTabletopRecogniserNode(int argc, char** argv);

}  // namespace hires_ros
