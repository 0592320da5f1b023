#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <nav_msgs/OccupancyGrid.h>
#include <ros/node_handle.h>

#include <optional>
#include <string>
#include <vector>

#include "hires/control/robot_names.h"
#include "hires/ros/transforms/transform_buffer.h"
#include "hires/ros/world/map_request.h"
#include "hires/world/map_fit.h"

namespace hires_ros {

struct MapCheckParams {
  std::string world;  ///< path of the SDF world
  std::string robot;  ///< path of the robot's profile or URDF
  hires::control::RobotNames names;
  hires::world::MapFitParams fit;
};

/// ~scene (config/scene.yaml where there is none); ~world, ~robot, ~names, ~map_to_world.
/// @throws hires::base::ConfigError.
MapCheckParams LoadMapCheckParams();

/// How the frame of a map lies in the world, or why that is not known.
struct MapPlace {
  std::optional<hires::geometry::MapToWorld> map_to_world;
  std::string why_not;  ///< for people
};

/// A map may be in any frame that tf connects with the one in which the robot is localised, and
/// that lies level in it.
MapPlace PlaceOf(const std::string& frame, const hires::control::RobotNames& names,
                 const TransformBuffer& tree);

/// Height of the robot's laser over the floor [m], in its driving posture.
/// @throws hires::base::ConfigError for a robot without one.
double LaserHeight(const std::string& robot_path);

/// Compares the robot's map with the world that is imagined, once at first and whenever a new map
/// comes. A map that does not belong to the world is a reason to end: whatever the robot were told,
/// it would be in the wrong place.
class MapCheckNode {
 public:
  MapCheckNode(const MapCheckParams& params, ros::NodeHandle* nh);

  /// Until a map does not fit, or ROS ends.
  /// @return why it does not; empty: ROS ended.
  std::string Run();

 private:
  void OnMap(const nav_msgs::OccupancyGrid& map);
  void AskForMap();
  void Compare();
  void ListenToTransforms();
  void Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  const MapCheckParams params_;
  const hires::world::OccupancyGrid slice_;
  ros::NodeHandle nh_;
  ros::Subscriber subscriber_;
  MapRequest map_server_;
  bool asks_;                           // the map server, where no map comes by itself
  std::optional<ros::WallTime> asked_;  // when
  TransformBuffer tree_;
  std::vector<ros::Subscriber> transforms_;  // where a map is in another frame than the robot's
  std::optional<nav_msgs::OccupancyGrid> new_map_;  // not compared yet
  ros::WallTime came_;                              // when
  diagnostic_updater::Updater updater_;
  std::optional<hires::world::MapFit> fit_;
  std::string misfit_;
};

}  // namespace hires_ros
