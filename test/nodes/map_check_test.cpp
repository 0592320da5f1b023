#include <gmock/gmock.h>

#include "hires/base/error.h"
#include "hires/ros/robot/robot_messages.h"
#include "nodes/map_check/map_check_node.h"

namespace hires_ros::map_check_test {
namespace {

using ::testing::HasSubstr;

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
