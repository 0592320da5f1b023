#include "hires/ros/world/map_messages.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "hires/base/error.h"

namespace hires_ros::map_messages_test {
namespace {

using hires::world::Cell;
using ::testing::HasSubstr;

nav_msgs::OccupancyGrid SmallMap() {
  nav_msgs::OccupancyGrid map;
  map.info.width = 3;
  map.info.height = 2;
  map.info.resolution = 0.05f;
  map.info.origin.position.x = -1.0;
  map.info.origin.position.y = 2.0;
  map.info.origin.orientation.w = 1.0;
  map.data = {0, 100, -1, 19, 50, 66};
  return map;
}

std::string ErrorOf(const nav_msgs::OccupancyGrid& map) {
  try {
    FromMsg(map);
  } catch (const hires::base::ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(MapMessagesTest, AGridComesBackFromItsMessage) {
  const auto grid = FromMsg(SmallMap());
  std_msgs::Header header;
  header.frame_id = "map";
  header.stamp = ros::Time(7.0);
  const nav_msgs::OccupancyGrid map = ToMsg(grid, header);
  EXPECT_EQ(map.header.frame_id, "map");
  EXPECT_EQ(map.info.map_load_time, ros::Time(7.0));
  EXPECT_THAT(map.data, testing::ElementsAre(0, 100, -1, 0, -1, 100));
  const auto other = FromMsg(map);
  EXPECT_EQ(other.cells, grid.cells);
  EXPECT_EQ(other.width, grid.width);
  EXPECT_EQ(other.origin, grid.origin);
}

TEST(MapMessagesTest, AMessageIsTheGridThatItSays) {
  const auto grid = FromMsg(SmallMap());
  EXPECT_EQ(grid.width, 3);
  EXPECT_EQ(grid.height, 2);
  EXPECT_NEAR(grid.resolution, 0.05, 1e-8);
  EXPECT_EQ(grid.origin, Eigen::Vector2d(-1.0, 2.0));
  EXPECT_THAT(grid.cells, testing::ElementsAre(Cell::kFree, Cell::kOccupied, Cell::kUnknown,
                                               Cell::kFree, Cell::kUnknown, Cell::kOccupied));
}

TEST(MapMessagesTest, ATurnedOriginTurnsTheGrid) {
  nav_msgs::OccupancyGrid map = SmallMap();
  map.info.origin.orientation.z = map.info.origin.orientation.w = std::sqrt(0.5);
  const auto grid = FromMsg(map);
  EXPECT_EQ(grid.width, 2);
  EXPECT_EQ(grid.height, 3);
  EXPECT_NEAR(grid.origin.x(), -1.0 - 2 * 0.05, 1e-6);
  EXPECT_EQ(grid.at(1, 1), Cell::kOccupied) << "the second cell of the lower row";
}

TEST(MapMessagesTest, AMapThatIsNoneIsRefused) {
  nav_msgs::OccupancyGrid map = SmallMap();
  map.data.pop_back();
  EXPECT_THAT(ErrorOf(map), HasSubstr("3 x 2 cells and 5 values"));
  EXPECT_THAT(ErrorOf({}), HasSubstr("0 x 0 cells"));
  map = SmallMap();
  map.info.resolution = 0.0f;
  EXPECT_THAT(ErrorOf(map), HasSubstr("resolution is 0"));
  map = SmallMap();
  map.info.origin.orientation.x = 0.1;
  EXPECT_THAT(ErrorOf(map), HasSubstr("origin is tilted"));
  map = SmallMap();
  map.info.origin.position.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(ErrorOf(map), HasSubstr("origin is not finite"));
}

}  // namespace
}  // namespace hires_ros::map_messages_test
