#include "robot/drive_guess.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace hires::robot::drive_guess_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

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

/// A wheel that a joint with these limits steers; wheelbase 0.8 m, `y` [m] off the middle.
std::string Steered(const std::string& name, double y, const std::string& joint) {
  return fmt::format(
             R"(<joint name="{0}_knuckle" {2}<origin xyz="0.8 {1} 0"/><parent link="base"/><child link="{0}"/><axis xyz="0 0 1"/></joint>
<link name="{0}"/>)",
             name, y, joint) +
         Turning(name + "_wheel", name, "0 1 0");
}

const std::string kRearWheels =
    Turning("left", "base", "0 1 0") + Turning("right", "base", "0 -1 0");

TEST(DriveGuessTest, SteeredWheelsBesideFixedOnesMakeACar) {
  const std::string limited =
      R"(type="revolute"><limit lower="-0.6" upper="0.5" effort="1" velocity="1"/>)";
  const DriveGuess guess =
      GuessFor(kRearWheels + Steered("a", 0.3, limited) + Steered("b", -0.3, limited));
  EXPECT_EQ(guess.drive, Drive::kCarLike);
  EXPECT_NEAR(guess.min_turning_radius, 0.8 / std::tan(0.5) + 0.3, 1e-9);  // the inner wheel
  EXPECT_THAT(guess.why, AllOf(HasSubstr("left_joint, right_joint"), HasSubstr("0.50 rad of a_"),
                               HasSubstr("min_turning_radius=1.76 m")));
}

TEST(DriveGuessTest, ASteeringJointWithoutLimitsHasAssumedOnes) {
  EXPECT_EQ(GuessFor(kRearWheels + Steered("a", 0.0, R"(type="continuous">)")).drive,
            Drive::kDifferential)
      << "a caster that trails";
  const DriveGuess guess =
      GuessFor(kRearWheels + Steered("front_steer", 0.0, R"(type="continuous">)"));
  EXPECT_EQ(guess.drive, Drive::kCarLike);
  EXPECT_NEAR(guess.min_turning_radius, 0.8 / std::tan(0.5), 1e-9);
  EXPECT_THAT(guess.why, HasSubstr("ASSUMED"));
}

TEST(DriveGuessTest, ACarWhoseRootIsNotOverItsAxleIsToldSo) {
  const auto rear = [](const char* name, double y) {
    return fmt::format(
        R"(<joint name="{0}" type="continuous"><origin xyz="-0.3 {1} 0"/><parent link="base"/><child link="{0}"/><axis xyz="0 1 0"/></joint><link name="{0}"/>)",
        name, y);
  };
  const std::string steered = Steered("steer", 0.0, R"(type="continuous">)");
  const DriveGuess guess = GuessFor(rear("left", 0.2) + rear("right", -0.2) + steered);
  EXPECT_NEAR(guess.min_turning_radius, 1.1 / std::tan(0.5), 1e-9);
  EXPECT_THAT(guess.why, AllOf(HasSubstr("x -0.30 m"), HasSubstr("base_link")));
  EXPECT_THAT(GuessFor(kRearWheels + steered).why, Not(HasSubstr("base_link")));
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
