#pragma once

#include <map>
#include <string>
#include <vector>

#include "hires/geometry/map_to_world.h"

namespace hires::control {

/// How controllers of joints are told. Of an action only its goals are used: whether a motion has
/// succeeded is judged by the joints.
enum class TrajectoryInterface {
  kJointTrajectory,       ///< topic of trajectory_msgs/JointTrajectory (PR2)
  kFollowJointTrajectory  ///< action of control_msgs
};

/// How controllers of grippers are told.
enum class GripperInterface {
  kPr2GripperCommand,  ///< topic of pr2_controllers_msgs
  kGripperCommand      ///< action of control_msgs; its position is the gap between the tips
};

/// Topics of sensors that nothing here needs for driving and grasping; empty: the robot has none,
/// or does not say it.
struct SensorNames {
  std::string depth_cloud;      ///< sensor_msgs/PointCloud2, organised, with colours
  std::string depth_image;      ///< sensor_msgs/Image, 16UC1 in mm (REP 118)
  std::string depth_info;       ///< sensor_msgs/CameraInfo
  std::string colour_image;     ///< sensor_msgs/Image, rgb8
  std::string colour_info;      ///< sensor_msgs/CameraInfo
  std::string thermal_image;    ///< sensor_msgs/Image, mono16 in centikelvin
  std::string thermal_colours;  ///< sensor_msgs/Image, rgb8: for people
  std::string thermal_info;     ///< sensor_msgs/CameraInfo
  std::string tilt_scan;        ///< sensor_msgs/LaserScan
  std::string tilt_cloud;       ///< sensor_msgs/PointCloud2: one for each sweep
  std::string tray_scan;        ///< sensor_msgs/LaserScan
  std::string inertia;          ///< sensor_msgs/Imu of the base's inertial unit
};

/// What a robot calls its topics, frames, joints' groups and servers: one YAML file per kind of
/// robot (config/robots/pr2_names.yaml). Topics and servers are relative, so that a launch file can
/// put them elsewhere; frames are tf's.
struct RobotNames {
  std::string map_frame, odometry_frame, base_frame;  ///< REP 105

  std::string base_command;   ///< geometry_msgs/Twist
  std::string odometry;       ///< nav_msgs/Odometry
  std::string joint_states;   ///< sensor_msgs/JointState
  std::string localisation;   ///< geometry_msgs/PoseWithCovarianceStamped; its covariance counts
  std::string base_scan;      ///< sensor_msgs/LaserScan
  std::string map;            ///< nav_msgs/OccupancyGrid, latched
  std::string static_map;     ///< nav_msgs/GetMap, where no map is latched; empty: none
  std::string motors_halted;  ///< std_msgs/Bool; empty: the robot has none
  std::string robot_description;  ///< parameter

  /// Group of joints -> topic of its controller; of an action its goals (".../goal").
  std::map<std::string, std::string> trajectories;
  TrajectoryInterface trajectory_interface{TrajectoryInterface::kJointTrajectory};
  std::map<std::string, std::string> grippers;  ///< arm -> topic, likewise
  GripperInterface gripper_interface{GripperInterface::kPr2GripperCommand};

  SensorNames sensors;

  /// How the robot's map lies in the world; not in the file, for it is the laboratory's.
  geometry::MapToWorld map_to_world;

  struct MoveBase {
    std::string action;   ///< move_base_msgs/MoveBaseAction; empty: the robot has none
    std::string planner;  ///< dynamic_reconfigure server of the local planner; empty with `action`
    /// Limit (max_linear_velocity, ...) -> what local planners have called it, newest first.
    std::map<std::string, std::vector<std::string>> parameters;
  } move_base;
};

/// @throws base::ConfigError naming file and line: missing or unknown fields, groups
/// and arms that there are not, names that are not ROS names, two groups with one topic.
RobotNames ReadRobotNames(const std::string& path);

/// As ReadRobotNames, of text; `where` stands for the file's name in messages.
RobotNames ParseRobotNames(const std::string& yaml, const std::string& where);

}  // namespace hires::control
