#include "nodes/middle_layer/drive_display.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "hires/geometry/angles.h"
#include "hires/navigation/costmap.h"
#include "hires/ros/values/geometry_messages.h"

namespace hires_ros::drive_display_test {
namespace {

using hires::geometry::Flatten;
using hires::geometry::kPi;
using hires::geometry::MapToWorld;
using hires::geometry::Pose2;

const MapToWorld kTurned{{1.0, 2.0, kPi / 2}, 2.0};

std_msgs::Header InMapFrame() {
  std_msgs::Header header;
  header.frame_id = "lab_map";
  header.stamp.fromSec(12.5);
  return header;
}

TEST(DriveDisplayTest, APathStandsInTheRobotsMap) {
  const nav_msgs::Path path =
      PathMsg({{1.0, 2.0, 0.0}, {1.0, 4.0, kPi / 2}}, kTurned, InMapFrame());
  EXPECT_EQ(path.header.frame_id, "lab_map");
  ASSERT_EQ(path.poses.size(), 2u);
  EXPECT_EQ(path.poses[1].header.frame_id, "lab_map");
  EXPECT_EQ(path.poses[1].header.stamp, ros::Time(12.5));
  const Pose2 first = Flatten(FromMsg(path.poses[0].pose));
  const Pose2 last = Flatten(FromMsg(path.poses[1].pose));
  EXPECT_NEAR(first.x, 0.0, 1e-12);
  EXPECT_NEAR(first.yaw, -kPi / 2, 1e-12);
  EXPECT_NEAR(last.x, 1.0, 1e-12);
  EXPECT_NEAR(last.y, 0.0, 1e-12);
  EXPECT_NEAR(last.yaw, 0.0, 1e-12);
}

/// The world's centre of a cell of a message, as whoever reads it finds it.
Eigen::Vector2d CentreInWorld(const nav_msgs::OccupancyGrid& grid, std::size_t cell) {
  const double resolution = static_cast<double>(grid.info.resolution);
  const Pose2 X_MG = Flatten(FromMsg(grid.info.origin));
  const Eigen::Vector2d p_G(static_cast<double>(cell % grid.info.width) + 0.5,
                            static_cast<double>(cell / grid.info.width) + 0.5);
  return kTurned.ToWorld(X_MG * Eigen::Vector2d(resolution * p_G));
}

TEST(DriveDisplayTest, ACostmapLiesInATurnedMapWhereItsObstaclesAre) {
  hires::world::OccupancyGrid world;
  world.resolution = 0.5;
  world.width = world.height = 40;
  world.origin = {-10.0, -10.0};
  world.cells.assign(1600, hires::world::Cell::kFree);
  world.cells[24 * 40 + 23] = hires::world::Cell::kOccupied;
  hires::skills::DriveView drive;
  drive.costmap = std::make_shared<const hires::navigation::Costmap>(
      world, 0.3, hires::navigation::CostmapParams{});
  drive.X_MB = {0.2, 0.7, 1.0};
  const nav_msgs::OccupancyGrid grid = CostmapMsg(drive, kTurned, InMapFrame());
  EXPECT_EQ(grid.header.frame_id, "lab_map");
  EXPECT_NEAR(static_cast<double>(grid.info.resolution), 0.25, 1e-6);
  EXPECT_EQ(grid.info.width, 13u) << "3 m to each side, and the robot's own cell";
  ASSERT_EQ(grid.data.size(), 169u);
  const auto obstacle = std::find(grid.data.begin(), grid.data.end(), 100);
  ASSERT_NE(obstacle, grid.data.end());
  EXPECT_EQ(std::count(grid.data.begin(), grid.data.end(), 100), 1);
  const Eigen::Vector2d found =
      CentreInWorld(grid, static_cast<std::size_t>(obstacle - grid.data.begin()));
  EXPECT_NEAR((found - world.CentreOf(23, 24)).norm(), 0.0, 1e-6);
}

TEST(DriveDisplayTest, NoCostmapIsOneUnknownCell) {
  const nav_msgs::OccupancyGrid grid = NoCostmapMsg(InMapFrame());
  EXPECT_EQ(grid.info.width * grid.info.height, 1u);
  ASSERT_EQ(grid.data.size(), 1u);
  EXPECT_EQ(grid.data[0], -1);
  EXPECT_EQ(grid.info.origin.orientation.w, 1.0) << "RViz refuses a quaternion of 0";
}

}  // namespace
}  // namespace hires_ros::drive_display_test
