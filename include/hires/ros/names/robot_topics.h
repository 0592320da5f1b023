#pragma once

/// What the nodes of this package call the topics between them and a robot; relative, so that a
/// launch file can put them elsewhere. What a robot calls its own: robot_names.h.
namespace hires_ros {

/// Of the simulated robot's base, behind whatever lets others win (RobotNames::base_command).
constexpr char kSimulatedBase[] = "base_controller/command";
constexpr char kTransforms[] = "/tf";
constexpr char kStaticTransforms[] = "/tf_static";

/// geometry_msgs/PoseWithCovarianceStamped: a person says where the robot is.
constexpr char kInitialPose[] = "initialpose";

constexpr char kDetections[] = "detections";  ///< what the head's camera recognises
constexpr char kObjectTemperatures[] = "object_temperatures";  ///< what a thermal camera says
constexpr char kKnownObjects[] = "known_objects";              ///< what is remembered of it
constexpr char kExecuteAction[] = "execute_action";

/// Between the node that drives and the guard of the base.
constexpr char kGuardCommand[] = "base_guard/cmd_vel";
constexpr char kGuardRequest[] = "base_guard/request";
constexpr char kGuardState[] = "base_guard/state";

/// The simulated robot and the middle layer take turns by these.
constexpr char kLockstepTick[] = "lockstep/tick";
constexpr char kLockstepAck[] = "lockstep/ack";

}  // namespace hires_ros
