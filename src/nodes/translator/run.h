#pragma once

namespace hires_ros {

/// What the program `translator` does.  @returns the exit code
int RunTranslatorNode(int argc, char** argv);

}  // namespace hires_ros
