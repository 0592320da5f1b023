#include "robot/drive_guess.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hires::robot::drive_guess_test {
namespace {

using ::testing::HasSubstr;

/// A link carried by a continuous joint about `axis`.
std::string Turning(const std::string& name, const std::string& parent, const std::string& axis) {
  return fmt::format(
      R"(<joint name="{0}_joint" type="continuous"><parent link="{1}"/><child link="{0}"/><axis xyz="{2}"/></joint>
<link name="{0}"/>)",
      name, parent, axis);
}

DriveGuess GuessFor(const std::string& wheels) {
  return GuessDrive(
      ParseRobotModel("<robot name=\"r\"><link name=\"base\"/>" + wheels + "</robot>", "r.urdf"));
}

/// A wheel on an arm that swivels.
std::string Caster(const std::string& name) {
  return Turning(name, "base", "0 0 1") + Turning(name + "_wheel", name, "0 1 0");
}

TEST(DriveGuessTest, TwoParallelWheelsAreDifferential) {
  const DriveGuess guess =
      GuessFor(Turning("left", "base", "0 1 0") + Turning("right", "base", "0 -1 0"));
  EXPECT_EQ(guess.drive, Drive::kDifferential);
  EXPECT_THAT(guess.why, HasSubstr("left_joint, right_joint"));
}

TEST(DriveGuessTest, SwivelCastersBesideDrivenWheelsChangeNothing) {
  const std::string casters = Caster("a") + Caster("b") + Caster("c") + Caster("d");
  EXPECT_EQ(GuessFor(casters + Turning("left", "base", "0 1 0") + Turning("right", "base", "0 1 0"))
                .drive,
            Drive::kDifferential);
  EXPECT_EQ(GuessFor(casters).drive, Drive::kOmnidirectional);
}

TEST(DriveGuessTest, ThreeWheelsInThreeDirectionsDriveAnywhere) {
  EXPECT_EQ(GuessFor(Turning("a", "base", "1 0 0") + Turning("b", "base", "-0.5 0.866 0") +
                     Turning("c", "base", "-0.5 -0.866 0"))
                .drive,
            Drive::kOmnidirectional);
}

TEST(DriveGuessTest, WithoutWheelsItIsTheOneThatEveryBaseCanDo) {
  EXPECT_EQ(GuessFor("").drive, Drive::kDifferential);
  EXPECT_EQ(GuessFor(Turning("head", "base", "0 0 1")).drive, Drive::kDifferential);
}

TEST(DriveGuessTest, APr2DrivesAnywhere) {
  const RobotModel pr2 = LoadRobotModel(std::string(HIRES_SOURCE_DIR) + "/urdf/pr2_tray.urdf");
  EXPECT_EQ(GuessDrive(pr2).drive, Drive::kOmnidirectional);
}

}  // namespace
}  // namespace hires::robot::drive_guess_test
