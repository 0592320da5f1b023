#pragma once

#include <ros/node_handle.h>

#include <functional>
#include <string>

namespace hires_ros {

/// What SIGINT, SIGTERM and SIGHUP do to a node.
enum class OnStopSignal {
  kShutDown,  ///< ROS is shut down, as ShutDownRosOnSignals() does
  kNote,      ///< noted for IsStopWanted(), as NoteStopSignals() does
};

/// The main() of a node: starts ROS under `name`, which has to be free at the master; has `play`
/// make the node and keep it until it is over. A configuration that is wrong is said as by
/// EndMisconfigured, and a new master is met by a new start (MasterWatch).
///
///   int main(int argc, char** argv) {
///     return hires_ros::RunNode("planner", argc, argv, [](ros::NodeHandle* nh) {
///       hires_ros::PlannerNode node(hires_ros::LoadPlannerParams(), nh);
///       ros::spin();
///     });
///   }
/// @returns the exit code
int RunNode(const std::string& name, int argc, char** argv,
            const std::function<void(ros::NodeHandle*)>& play,
            OnStopSignal on_stop = OnStopSignal::kShutDown);

}  // namespace hires_ros
