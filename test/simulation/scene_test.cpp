#include "hires/simulation/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/messages.h"
#include "support/scenes.h"

namespace hires::simulation::scene_test {
namespace {

using test_support::ConfigErrorOf;
using test_support::Room;
using test_support::TrayRobot;
using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(SceneTest, ObjectsArePutOnTheTraySeenFromTheBase) {
  robot::Robot robot = TrayRobot();
  robot.profile.X_TO.translation = {0.01, -0.02, 0.0003};
  const auto scene = MakeScene(Room(), robot);
  EXPECT_NEAR(scene->X_BO.translation.x(), 0.21, 1e-12);
  EXPECT_NEAR(scene->X_BO.translation.y(), -0.02, 1e-12);
  EXPECT_NEAR(scene->X_BO.translation.z(), 0.3503, 1e-12);
  EXPECT_EQ(scene->robot_shapes_B.size(), 3u);
}

TEST(SceneTest, ShapesCountFromTheBaseLinkEvenIfItIsNotTheRoot) {
  robot::Robot robot = TrayRobot();
  robot.profile.base_link = "tray";  // 0.2 ahead of the root and 0.35 above it
  const auto scene = MakeScene(Room(), robot);
  const auto& base = scene->robot_shapes_B.front();
  EXPECT_NEAR(base.X_BS.translation.x(), -0.2, 1e-12);
  EXPECT_NEAR(base.X_BS.translation.z(), 0.17 - 0.35, 1e-12);
  EXPECT_NEAR(scene->X_BO.translation.norm(), 0.0, 1e-12);
}

TEST(SceneTest, ARobotWithoutATrayIsAScene) {
  robot::Robot robot = TrayRobot();
  robot.profile.tray_link.clear();
  EXPECT_NEAR(MakeScene(Room(), robot)->X_BO.translation.norm(), 0.0, 1e-12);
}

TEST(SceneTest, RefusesLinksThatTheRobotLacks) {
  robot::Robot robot = TrayRobot();
  robot.profile.tray_link = "tary";
  EXPECT_THAT(ConfigErrorOf([&] { MakeScene(Room(), robot); }),
              AllOf(HasSubstr("tray_robot"), HasSubstr("link 'tary' is unknown"),
                    HasSubstr("did you mean 'tray'")));
  robot.profile.tray_link = "tray";
  robot.profile.base_link = "bas";
  EXPECT_THAT(ConfigErrorOf([&] { MakeScene(Room(), robot); }), HasSubstr("link 'bas' is unknown"));
}

TEST(SceneTest, RefusesJointsThatTheRobotLacks) {
  robot::Robot robot = TrayRobot();
  robot.profile.joints["elbow"] = 0.3;
  EXPECT_THAT(ConfigErrorOf([&] { MakeScene(Room(), robot); }), HasSubstr("elbow"));
}

}  // namespace
}  // namespace hires::simulation::scene_test
