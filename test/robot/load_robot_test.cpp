#include "hires/robot/load_robot.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/robot/link_bounds.h"
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

/// A box with boards over one another, 0.3 m apart, each so long.
std::string ShelfUrdf(const std::vector<std::pair<std::string, double>>& boards) {
  std::string text =
      "<robot name='shelf'><link name='base_link'><collision><origin xyz='0 0 0.1'/><geometry><box "
      "size='0.5 0.4 0.2'/></geometry></collision></link>";
  double height = 0.2;
  for (const auto& [name, length] : boards) {
    height += 0.3;
    text += fmt::format(
        "<link name='{0}'><collision><geometry><box size='{1} 0.3 0.02'/></geometry></collision>"
        "</link><joint name='{0}_j' type='fixed'><origin xyz='0 0 {2}'/><parent link='base_link'/>"
        "<child link='{0}'/></joint>",
        name, length, height);
  }
  return text + "</robot>";
}

TEST(LoadAnyRobotTest, OfSeveralTraysTheOthersAreNamed) {
  const hires::test_support::TemporaryFolder folder;
  const auto told = [&](const std::vector<std::pair<std::string, double>>& boards) {
    return base::Join(LoadAnyRobot(folder.Write("shelf.urdf", ShelfUrdf(boards))).assumed, "\n");
  };
  EXPECT_THAT(told({{"tray_1", 0.4}, {"tray_2", 0.4}, {"tray_clip", 0.05}}),
              testing::AllOf(testing::HasSubstr("'tray_1'"),
                             testing::HasSubstr("; tray_2 may be meant as well")));
  EXPECT_THAT(told({{"low_tray", 0.3}, {"mid_tray", 0.4}, {"top_tray", 0.3}}),
              testing::AllOf(testing::HasSubstr("'mid_tray'"), testing::HasSubstr("low_tray"),
                             testing::HasSubstr("top_tray")));
  for (const char* other : {"shelf", "tray_clip"}) {
    EXPECT_THAT(told({{"tray", 0.4}, {other, 0.1}}),
                testing::Not(testing::HasSubstr("may be meant as well")));
  }
}

TEST(LoadAnyRobotTest, ShapesThatAreTooHighForAFootprintAreSaidWithTheirHeights) {
  const hires::test_support::TemporaryFolder folder;
  const auto why = [&](double unit, double lowest) {
    return hires::test_support::ConfigErrorOf([&] {
      LoadAnyRobot(folder.Write(
          "bot.urdf",
          fmt::format("<robot name='bot'><link name='base_link'><collision><origin xyz='0 0 {0}'/>"
                      "<geometry><box size='{1} {1} {1}'/></geometry></collision></link></robot>",
                      lowest + 0.5 * unit, unit)));
    });
  };
  EXPECT_THAT(why(400.0, 50.0), testing::HasSubstr("they lie 50 m to 450 m above it, as if their "
                                                   "unit were not the metre"));
  EXPECT_THAT(why(40.0, 5.0), testing::HasSubstr("not the metre"));
  EXPECT_THAT(why(1.0, 3.0), testing::AllOf(testing::HasSubstr("they lie 3 m to 4 m above it)"),
                                            testing::Not(testing::HasSubstr("metre"))));
  EXPECT_THAT(why(0.4, 0.05), testing::HasSubstr("no ConfigError"));
}

TEST(LoadAnyRobotTest, LinksThatNothingCoversAreFoundLargestFirst) {
  const hires::test_support::TemporaryFolder folder;
  const auto open = [&](const std::vector<std::pair<std::string, double>>& boards) {
    return LinksOpenAbove(LoadAnyRobot(folder.Write("shelf.urdf", ShelfUrdf(boards))));
  };
  EXPECT_THAT(open({}), testing::ElementsAre("base_link"));
  EXPECT_THAT(open({{"deck", 0.4}}), testing::ElementsAre("deck"));
  EXPECT_THAT(open({{"low", 0.4}, {"high", 0.2}}), testing::ElementsAre("high"));
  EXPECT_THAT(open({{"rail", 0.05}}), testing::IsEmpty());
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
