#include "hires/robot/load_robot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::robot::load_robot_test {
namespace {

const std::string kRoot = HIRES_SOURCE_DIR;

TEST(LoadAnyRobotTest, ProfileAndBareUrdfGiveTheSameCart) {
  const Robot cart = LoadAnyRobot(kRoot + "/config/robots/cart.yaml");
  const Robot bare = LoadAnyRobot(kRoot + "/urdf/cart.urdf");
  EXPECT_EQ(bare.model.hash, cart.model.hash);
  EXPECT_EQ(bare.profile.tray_link, cart.profile.tray_link);
}

TEST(LoadAnyRobotTest, ACarsUrdfTellsHowItSteers) {
  const Robot car = LoadAnyRobot(kRoot + "/config/robots/car.yaml");
  const Robot bare = LoadAnyRobot(kRoot + "/urdf/car.urdf");
  EXPECT_EQ(bare.profile.tray_link, car.profile.tray_link);
  EXPECT_EQ(bare.profile.base_link, car.profile.base_link);
  EXPECT_EQ(bare.profile.base_controller.drive, Drive::kCarLike);
  EXPECT_EQ(car.profile.base_controller.drive, Drive::kCarLike);
  EXPECT_NEAR(bare.profile.base_controller.min_turning_radius,
              car.profile.base_controller.min_turning_radius, 0.01);
}

TEST(ReadUrdfOfTest, ProfileAndBareUrdfGiveTheSameText) {
  for (const char* path : {"/config/robots/cart.yaml", "/urdf/cart.urdf"}) {
    const Robot robot = LoadAnyRobot(kRoot + path);
    EXPECT_EQ(ReadUrdfOf(kRoot + path, robot.profile),
              base::ReadTextFile(kRoot + "/urdf/cart.urdf"))
        << path;
  }
}

TEST(LoadAnyRobotTest, AUrdfThatIsMissingNamesTheProfile) {
  const hires::test_support::TemporaryFolder folder;
  const std::string profile = folder.Write("cart.yaml", "urdf: nowhere/cart.urdf\n");
  EXPECT_THAT(hires::test_support::ConfigErrorOf([&] { LoadAnyRobot(profile); }),
              testing::AllOf(testing::HasSubstr(profile + ": urdf is 'nowhere/cart.urdf'"),
                             testing::HasSubstr("from the profile's folder")));
}

TEST(LoadAnyRobotTest, AFileThatIsMissingIsAnErrorOfItsKind) {
  EXPECT_THROW(LoadAnyRobot(kRoot + "/urdf/nothing.URDF"), base::ConfigError);
  EXPECT_THROW(LoadAnyRobot(kRoot + "/config/robots/nothing.yaml"), base::ConfigError);
}

TEST(LoadAnyRobotTest, AFileOfAnotherKindIsToldWhatIsWanted) {
  const auto error_of = [](const std::string& path) {
    return hires::test_support::ConfigErrorOf([&] { LoadAnyRobot(path); });
  };
  EXPECT_THAT(error_of(kRoot + "/worlds/workshop.world"),
              testing::HasSubstr("workshop.world: unknown file type '.world' for a robot; wanted a "
                                 "profile (.yaml), a URDF (.urdf) or a xacro file"));
  EXPECT_THAT(error_of(kRoot + "/worlds/objects.yaml"),
              testing::HasSubstr("objects.yaml: is no robot's profile, which begins with the name "
                                 "of its URDF"));
  const hires::test_support::TemporaryFolder folder;
  EXPECT_THAT(error_of(folder.Write("mistyped.yaml", "urfd: cart.urdf\n")),
              testing::HasSubstr("key 'urfd' is unknown; did you mean 'urdf'?"));
}

}  // namespace
}  // namespace hires::robot::load_robot_test
