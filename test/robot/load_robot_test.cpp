#include "hires/robot/load_robot.h"

#include <gtest/gtest.h>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::robot::load_robot_test {
namespace {

const std::string kRoot = HIRES_SOURCE_DIR;

TEST(LoadAnyRobotTest, ProfileAndBareUrdfGiveTheSameCart) {
  const Robot cart = LoadAnyRobot(kRoot + "/config/robots/cart.yaml");
  const Robot bare = LoadAnyRobot(kRoot + "/urdf/cart.urdf");
  EXPECT_EQ(bare.model.hash, cart.model.hash);
  EXPECT_EQ(bare.profile.tray_link, cart.profile.tray_link);
}

TEST(ReadUrdfOfTest, ProfileAndBareUrdfGiveTheSameText) {
  for (const char* path : {"/config/robots/cart.yaml", "/urdf/cart.urdf"}) {
    const Robot robot = LoadAnyRobot(kRoot + path);
    EXPECT_EQ(ReadUrdfOf(kRoot + path, robot.profile),
              base::ReadTextFile(kRoot + "/urdf/cart.urdf"))
        << path;
  }
}

TEST(LoadAnyRobotTest, AFileThatIsMissingIsAnErrorOfItsKind) {
  EXPECT_THROW(LoadAnyRobot(kRoot + "/urdf/nothing.URDF"), base::ConfigError);
  EXPECT_THROW(LoadAnyRobot(kRoot + "/config/robots/nothing.yaml"), base::ConfigError);
}

}  // namespace
}  // namespace hires::robot::load_robot_test
