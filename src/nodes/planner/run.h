#pragma once

namespace hires_ros {

/// What the program `planner` does.  @returns the exit code
int RunPlannerNode(int argc, char** argv);

}  // namespace hires_ros
