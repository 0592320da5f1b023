#include <gmock/gmock.h>

#include <cmath>

#include "hires/base/error.h"
#include "hires/ros/robot_messages.h"
#include "nodes/map_check/map_check_node.h"

namespace hires_ros::map_check_test {
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

TEST(MapCheckTest, AMessageIsTheGridThatItSays) {
  const auto grid = FromMsg(SmallMap());
  EXPECT_EQ(grid.width, 3);
  EXPECT_EQ(grid.height, 2);
  EXPECT_NEAR(grid.resolution, 0.05, 1e-8);
  EXPECT_EQ(grid.origin, Eigen::Vector2d(-1.0, 2.0));
  EXPECT_THAT(grid.cells, testing::ElementsAre(Cell::kFree, Cell::kOccupied, Cell::kUnknown,
                                               Cell::kFree, Cell::kUnknown, Cell::kOccupied));
}

TEST(MapCheckTest, AMapThatIsNoneIsRefused) {
  nav_msgs::OccupancyGrid map = SmallMap();
  map.data.pop_back();
  EXPECT_THAT(ErrorOf(map), HasSubstr("3 x 2 cells and 5 values"));
  EXPECT_THAT(ErrorOf({}), HasSubstr("0 x 0 cells"));
  map = SmallMap();
  map.info.resolution = 0.0f;
  EXPECT_THAT(ErrorOf(map), HasSubstr("resolution is 0"));
  map = SmallMap();
  map.info.origin.orientation.z = 0.1;
  EXPECT_THAT(ErrorOf(map), HasSubstr("origin is turned"));
}

/// map -> venue (1, 2; yaw 90 deg) -> lab_map (3, 0; yaw 0): lab_map's origin is at (1, 5) in the
/// map.
class MapFrameTest : public testing::Test {
 protected:
  void Tell(const std::string& parent, const std::string& child,
            const hires::geometry::Pose3& X_PC) {
    tf2_msgs::TFMessage msg;
    msg.transforms.push_back(MakeTransform(parent, child, X_PC, ros::Time(1.0)));
    tree_.Take(msg, true);
  }
  hires::control::RobotNames names_ =
      hires::control::ReadRobotNames(HIRES_SOURCE_DIR "/config/robots/pr2_names.yaml");
  TransformBuffer tree_;
};

TEST_F(MapFrameTest, TheRobotsOwnMapNeedsNoTransform) {
  const MapPlace place = PlaceOf("/map", names_, tree_);
  ASSERT_TRUE(place.map_to_world);
  EXPECT_TRUE(place.map_to_world->is_identity());
}

TEST_F(MapFrameTest, AMapInAnotherFrameIsPutWhereTheTreeHasIt) {
  using hires::geometry::Lift;
  Tell("map", "venue", Lift({1.0, 2.0, M_PI / 2}));
  Tell("venue", "lab_map", Lift({3.0, 0.0, 0.0}));
  names_.map_to_world = {{10.0, 0.0, 0.0}, 2.0};
  const MapPlace place = PlaceOf("lab_map", names_, tree_);
  ASSERT_TRUE(place.map_to_world) << place.why_not;
  // 1 m ahead of lab_map's origin is (1, 6) in the map: (10, 0) and twice that in the world.
  const Eigen::Vector2d ahead = place.map_to_world->ToWorld(Eigen::Vector2d(1.0, 0.0));
  EXPECT_LT((ahead - Eigen::Vector2d(12.0, 12.0)).norm(), 1e-9);
}

TEST_F(MapFrameTest, AMapThatNothingConnectsIsRefusedWithBothFramesAndWhatIsKnown) {
  Tell("map", "odom_combined", {});
  Tell("venue", "lab_map", {});
  const MapPlace place = PlaceOf("lab_map", names_, tree_);
  EXPECT_FALSE(place.map_to_world);
  EXPECT_THAT(place.why_not, HasSubstr("it is in frame 'lab_map', wanted 'map'"));
  EXPECT_THAT(place.why_not, HasSubstr("(it knows lab_map < venue; map)"));
  EXPECT_THAT(PlaceOf("attic", names_, tree_).why_not, HasSubstr("tf does not know frame 'attic'"));
  EXPECT_THAT(PlaceOf("", names_, tree_).why_not, HasSubstr("it is in frame ''"));
}

TEST_F(MapFrameTest, AMapThatIsTiltedIsRefused) {
  Tell("map", "wall", {{}, hires::geometry::RotationFromRpy(M_PI / 2, 0.0, 0.0)});
  EXPECT_THAT(PlaceOf("wall", names_, tree_).why_not, HasSubstr("tilted by 1.571 rad"));
}

TEST(MapCheckTest, TheSliceLiesWhereTheLaserIs) {
  EXPECT_NEAR(LaserHeight(HIRES_SOURCE_DIR "/config/robots/pr2.yaml"), 0.303, 1e-6);
  EXPECT_THROW(LaserHeight(HIRES_SOURCE_DIR "/urdf/cart.urdf"), hires::base::ConfigError);
}

}  // namespace
}  // namespace hires_ros::map_check_test
