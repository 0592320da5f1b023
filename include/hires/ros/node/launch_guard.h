#pragma once

#include <string>

#include "hires/base/error.h"

namespace hires_ros {

/// Ends the roslaunch that started this process, if one did, as Ctrl-C would.
void EndLaunch();

/// What the main() of a node returns when its configuration is wrong: says so, and ends the launch
/// that would start the node again and again, to fail in the same way, if it is one of this
/// package: a launch file that includes one of ours goes on, for it may have started a robot's
/// drivers, unless the robot is the simulated one of closed_loop.launch.
int EndMisconfigured(const std::string& node, const hires::base::ConfigError& error);

/// Whether this node's name is free at its master: no other process that answers bears it. Where it
/// is taken, that is said once, and the launch is ended as by EndMisconfigured: each of two nodes
/// of one name would end the other again and again. A node that is dead, or this process before it
/// started again, does not count.
/// @pre ros::init was called, and nothing is registered yet.
bool ClaimName();

}  // namespace hires_ros
