#include "nodes/middle_layer/drive_display.h"

#include "hires/navigation/costmap_window.h"
#include "hires/navigation/dwa.h"
#include "hires/ros/names/topic_names.h"
#include "hires/ros/values/geometry_messages.h"

namespace hires_ros {
namespace {

using hires::geometry::MapToWorld;
using hires::geometry::Pose2;

constexpr double kCostmapPeriod = 0.5;  // [s] of the robot's time between two costmaps

geometry_msgs::Pose InMap(const Pose2& X_WB, const MapToWorld& map_to_world) {
  return hires_ros::ToMsg(hires::geometry::Lift(map_to_world.ToMap(X_WB)));
}

}  // namespace

nav_msgs::Path PathMsg(const std::vector<Pose2>& path, const MapToWorld& map_to_world,
                       const std_msgs::Header& header) {
  nav_msgs::Path msg;
  msg.header = header;
  msg.poses.resize(path.size());
  for (std::size_t i = 0; i < path.size(); ++i) {
    msg.poses[i].header = header;
    msg.poses[i].pose = InMap(path[i], map_to_world);
  }
  return msg;
}

nav_msgs::OccupancyGrid CostmapMsg(const hires::skills::DriveView& drive,
                                   const MapToWorld& map_to_world, const std_msgs::Header& header) {
  const auto window = hires::navigation::WindowAround(*drive.costmap, drive.X_MB.position(),
                                                      hires::navigation::kLocalHalfWidth);
  nav_msgs::OccupancyGrid msg;
  msg.header = header;
  msg.info.map_load_time = header.stamp;
  msg.info.resolution = static_cast<float>(window.resolution / map_to_world.scale);
  msg.info.width = msg.info.height = static_cast<std::uint32_t>(window.width);
  msg.info.origin = InMap({window.origin.x(), window.origin.y(), 0.0}, map_to_world);
  msg.data = window.occupancy;
  return msg;
}

nav_msgs::OccupancyGrid NoCostmapMsg(const std_msgs::Header& header) {
  nav_msgs::OccupancyGrid msg;
  msg.header = header;
  msg.info.map_load_time = header.stamp;
  msg.info.resolution = 0.05F;
  msg.info.width = msg.info.height = 1;
  msg.info.origin.orientation.w = 1.0;
  msg.data = {-1};
  return msg;
}

DriveDisplay::DriveDisplay(const std::string& map_frame, const MapToWorld& map_to_world,
                           ros::NodeHandle* nh)
    : map_frame_(map_frame),
      map_to_world_(map_to_world),
      plan_(nh->advertise<nav_msgs::Path>(kDrivePlan, 1, true)),
      costmap_(nh->advertise<nav_msgs::OccupancyGrid>(kLocalCostmap, 1, true)) {}

void DriveDisplay::Show(double time, const std::optional<hires::skills::DriveView>& drive) {
  if (!drive && !shown_) return;
  std_msgs::Header header;
  header.stamp.fromSec(time);
  header.frame_id = map_frame_;
  if (!drive) {
    shown_.reset();
    plan_.publish(PathMsg({}, map_to_world_, header));
    costmap_.publish(NoCostmapMsg(header));
    return;
  }
  const bool is_first = !shown_;
  if (drive->path != shown_) plan_.publish(PathMsg(*drive->path, map_to_world_, header));
  shown_ = drive->path;
  // A clock may begin again.
  if (!is_first && time >= shown_costmap_ && time < shown_costmap_ + kCostmapPeriod) return;
  shown_costmap_ = time;
  costmap_.publish(CostmapMsg(*drive, map_to_world_, header));
}

}  // namespace hires_ros
