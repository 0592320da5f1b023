#pragma once

namespace hires_ros {

/// What the program `odometry_filter` does.  @returns the exit code
int RunOdometryFilterNode(int argc, char** argv);

}  // namespace hires_ros
