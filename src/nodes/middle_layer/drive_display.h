#pragma once

#include <nav_msgs/OccupancyGrid.h>
#include <nav_msgs/Path.h>
#include <ros/node_handle.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/geometry/map_to_world.h"
#include "hires/skills/drive_view.h"

namespace hires_ros {

/// A path in the robot's map.
nav_msgs::Path PathMsg(const std::vector<hires::geometry::Pose2>& path,
                       const hires::geometry::MapToWorld& map_to_world,
                       const std_msgs::Header& header);

/// The part of the costmap that the local planner sees, in the robot's map.
nav_msgs::OccupancyGrid CostmapMsg(const hires::skills::DriveView& drive,
                                   const hires::geometry::MapToWorld& map_to_world,
                                   const std_msgs::Header& header);

/// What says that there is no costmap: a single unknown cell. RViz goes on showing the last grid
/// when it gets one without cells.
nav_msgs::OccupancyGrid NoCostmapMsg(const std_msgs::Header& header);

/// Shows what the base's action drives by, latched: the path whenever it is planned, the costmap at
/// 2 Hz of the robot's time, and when the drive has ended that there is neither.
class DriveDisplay {
 public:
  /// @param map_frame     of what is published
  /// @param map_to_world  how that map lies in the world that drives are in
  DriveDisplay(const std::string& map_frame, const hires::geometry::MapToWorld& map_to_world,
               ros::NodeHandle* nh);

  /// @param time   [s] of the look at the robot that it is about.
  /// @param drive  nothing while no action drives along a path.
  void Show(double time, const std::optional<hires::skills::DriveView>& drive);

 private:
  const std::string map_frame_;
  const hires::geometry::MapToWorld map_to_world_;
  ros::Publisher plan_, costmap_;
  std::shared_ptr<const std::vector<hires::geometry::Pose2>> shown_;  // null: there is no drive
  double shown_costmap_{0.0};                                         // [s] when, of the last one
};

}  // namespace hires_ros
