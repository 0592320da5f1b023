#pragma once

namespace hires_ros {

/// What the program `imagination_client` does.  @returns the exit code
int RunImaginationClientNode(int argc, char** argv);

}  // namespace hires_ros
