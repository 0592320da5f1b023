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

DriveGuess GuessFor(const std::string& wheels, const std::string& base_link = "base") {
  return GuessDrive(
      ParseRobotModel("<robot name=\"r\"><link name=\"base\"/>" + wheels + "</robot>", "r.urdf"),
      base_link);
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

TEST(DriveGuessTest, WheelsThatMayTurnOnAndOnAreWheelsWhateverTheirTypeIsCalled) {
  const auto wheel = [](const char* name, const char* limits) {
    return fmt::format(
        R"(<joint name="{0}" type="revolute"><parent link="base"/><child link="{0}_l"/><axis xyz="0 1 0"/><limit {1} effort="1" velocity="1"/></joint><link name="{0}_l"/>)",
        name, limits);
  };
  for (const char* limits : {R"(lower="-1e16" upper="1e16")", R"(lower="-inf" upper="inf")"})
    EXPECT_THAT(GuessFor(wheel("l", limits) + wheel("r", limits)).why, HasSubstr("wheels: l, r"));
  const char* narrow = R"(lower="-1" upper="1")";
  EXPECT_THAT(GuessFor(wheel("l", narrow) + wheel("r", narrow)).why, HasSubstr("no wheels"));
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

TEST(DriveGuessTest, OneSteeredWheelAndOneThatKeepsItsDirectionMakeACar) {
  const std::string front = Steered(
      "front", 0.0, R"(type="revolute"><limit lower="-1.2" upper="1.2" effort="1" velocity="1"/>)");
  const DriveGuess guess = GuessFor(Turning("rear", "base", "0 1 0") + front);
  EXPECT_EQ(guess.drive, Drive::kCarLike);
  EXPECT_NEAR(guess.min_turning_radius, 0.8 / std::tan(1.2), 1e-9);
  EXPECT_THAT(guess.why, AllOf(HasSubstr("a wheel that keeps its direction (rear_joint)"),
                               HasSubstr("1.20 rad of front_knuckle")));
  EXPECT_EQ(guess.misfit, "");
  EXPECT_EQ(GuessFor(Turning("roller", "base", "1 0 0") + front).drive, Drive::kDifferential)
      << "it rolls to the side";
  EXPECT_EQ(GuessFor(front).drive, Drive::kDifferential);
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

TEST(DriveGuessTest, ASteeringJointWithoutLimitsTakesThoseOfTheOneBesideIt) {
  const std::string limited =
      R"(type="revolute"><limit lower="-1.0" upper="1.0" effort="1" velocity="1"/>)";
  const DriveGuess guess = GuessFor(kRearWheels + Steered("left_steer", 0.1, limited) +
                                    Steered("right_steer", -0.1, R"(type="continuous">)"));
  EXPECT_EQ(guess.drive, Drive::kCarLike);
  EXPECT_NEAR(guess.min_turning_radius, 0.8 / std::tan(1.0) + 0.1, 1e-9);
  EXPECT_THAT(guess.why, AllOf(HasSubstr("1.00 rad of left_steer"), Not(HasSubstr("ASSUMED"))));
}

/// Four wheels, all steered, at x 0.3 m and -0.3 m, y 0.2 m and -0.2 m.
std::string AllSteered(double lower, double upper) {
  std::string wheels;
  for (const double x : {0.3, -0.3}) {
    for (const double y : {0.2, -0.2}) {
      const std::string name = fmt::format("w{}{}", x > 0.0 ? 'f' : 'b', y > 0.0 ? 'l' : 'r');
      wheels += fmt::format(
          R"(<joint name="{0}_hinge" type="revolute"><origin xyz="{1} {2} 0"/><parent link="base"/><child link="{0}"/><axis xyz="0 0 1"/><limit lower="{3}" upper="{4}" effort="1" velocity="1"/></joint><link name="{0}"/>)",
          name, x, y, lower, upper);
      wheels += Turning(name + "_wheel", name, "0 1 0");
    }
  }
  return wheels;
}

TEST(DriveGuessTest, CastersThatCannotTurnSidewaysMakeACar) {
  for (const double limit : {0.3, 0.5, 1.2}) {
    const DriveGuess guess = GuessFor(AllSteered(-limit, limit));
    EXPECT_EQ(guess.drive, Drive::kCarLike) << limit;
    EXPECT_NEAR(guess.min_turning_radius, 0.6 / std::tan(limit) + 0.2, 1e-9);
    EXPECT_THAT(guess.why, AllOf(HasSubstr("wfl_hinge"), HasSubstr("is not modelled")));
    EXPECT_EQ(guess.misfit, "") << "it turns about its middle";
  }
  EXPECT_EQ(GuessFor(AllSteered(-1.57, 1.57)).drive, Drive::kOmnidirectional);
  EXPECT_EQ(GuessFor(AllSteered(0.0, 3.14)).drive, Drive::kOmnidirectional);
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

/// A wheel somewhere on the base.
std::string WheelAt(const std::string& name, double x, double y, const std::string& axis,
                    double z = 0.1) {
  return fmt::format(
      R"(<joint name="{0}" type="continuous"><origin xyz="{1} {2} {4}"/><parent link="base"/><child link="{0}_link"/><axis xyz="{3}"/></joint><link name="{0}_link"/>)",
      name, x, y, axis, z);
}

/// A link that is fixed to the base, turned by `yaw`.
std::string LinkAt(const std::string& name, double x, double yaw) {
  return fmt::format(
      R"(<joint name="{0}_j" type="fixed"><origin xyz="{1} 0 0" rpy="0 0 {2}"/><parent link="base"/><child link="{0}"/></joint><link name="{0}"/>)",
      name, x, yaw);
}

TEST(DriveGuessTest, ADifferentialRobotIsToldOfAnAxleThatIsNotBelowItsBase) {
  for (const double x : {-0.35, -0.06, -0.04, 0.0, 0.04, 0.06, 0.35}) {
    const std::string wheels = WheelAt("l", x, 0.2, "0 1 0") + WheelAt("r", x, -0.2, "0 -1 0");
    const DriveGuess guess = GuessFor(wheels);
    EXPECT_EQ(guess.drive, Drive::kDifferential);
    EXPECT_EQ(guess.misfit.empty(), std::abs(x) < 0.05) << x << guess.misfit;
    EXPECT_EQ(GuessFor(wheels + LinkAt("axle", x, 0.0), "axle").misfit, "") << x;
    const DriveGuess four =
        GuessFor(wheels + WheelAt("fl", -x, 0.2, "0 1 0") + WheelAt("fr", -x, -0.2, "0 1 0"));
    EXPECT_EQ(four.misfit, "") << "it turns about the middle of all four";
  }
  const DriveGuess rear =
      GuessFor(WheelAt("l", -0.35, 0.2, "0 1 0") + WheelAt("r", -0.35, -0.2, "0 1 0") +
               WheelAt("fan", 0.35, 0.0, "0 1 0", 1.0));
  EXPECT_THAT(rear.why,
              AllOf(HasSubstr("parallel wheels: "), HasSubstr("; but the axle lies at x -0.35 m"),
                    HasSubstr("of 'base'"), HasSubstr("base_link")));
}

TEST(DriveGuessTest, ARobotWhoseWheelsRollAsideOfXIsToldSo) {
  for (const double angle : {0.0, 0.1, 0.5, 1.0, 0.5 * M_PI, 2.0, M_PI}) {
    const std::string axis = fmt::format("{} {} 0", std::sin(angle), std::cos(angle));
    const std::string wheels = WheelAt("l", 0.2 * std::sin(angle), 0.2 * std::cos(angle), axis) +
                               WheelAt("r", -0.2 * std::sin(angle), -0.2 * std::cos(angle), axis);
    const DriveGuess guess = GuessFor(wheels);
    const bool is_askew = std::abs(std::sin(angle)) > 0.2;
    EXPECT_EQ(guess.misfit.empty(), !is_askew) << angle << guess.misfit;
    EXPECT_EQ(guess.why.find("degrees off the x axis") != std::string::npos, is_askew) << guess.why;
    EXPECT_EQ(GuessFor(wheels + LinkAt("ahead", 0.0, -angle), "ahead").misfit, "") << angle;
  }
  const std::string along_y = WheelAt("l", -0.2, 0.0, "1 0 0") + WheelAt("r", 0.2, 0.0, "1 0 0");
  EXPECT_THAT(GuessFor(along_y).why, HasSubstr("; but its wheels roll 90 degrees off the x axis"));
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

std::string Plugin(const std::string& file) {
  return fmt::format(R"(<gazebo><plugin name="p" filename="{}"><max>1</max></plugin></gazebo>)",
                     file);
}

TEST(DriveGuessTest, WhereWheelsDoNotTellASimulatorsPluginDoes) {
  const std::string other = Plugin("libgazebo_ros_control.so");
  for (const char* file :
       {"libgazebo_ros_planar_move.so", "libignition-gazebo-mecanum-drive-system.so",
        "gz-sim-velocity-control-system", "ignition-gazebo-velocity-control-system"}) {
    const DriveGuess guess = GuessFor(other + Plugin(file));
    EXPECT_EQ(guess.drive, Drive::kOmnidirectional) << file;
    EXPECT_THAT(guess.why, HasSubstr(file));
    const DriveGuess wheels = GuessFor(kRearWheels + Plugin(file));
    EXPECT_EQ(wheels.drive, Drive::kDifferential) << "its wheels tell";
    EXPECT_THAT(wheels.why, AllOf(HasSubstr("parallel wheels"), HasSubstr(file)));
  }
  for (const char* file : {"libgazebo_ros_diff_drive.so", "libgazebo_ros_skid_steer_drive.so",
                           "libignition-gazebo-diff-drive-system.so", "gz-sim-diff-drive-system"}) {
    const DriveGuess guess = GuessFor(Plugin(file) + other);
    EXPECT_EQ(guess.drive, Drive::kDifferential) << file;
    EXPECT_THAT(guess.why, HasSubstr(file));
  }
  EXPECT_THAT(GuessFor(other).why, Not(HasSubstr("plugin")));
}

TEST(DriveGuessTest, ByACarsPluginItsWheelsThatSwivelAreSteered) {
  for (const char* file :
       {"libgazebo_ros_ackermann_drive.so", "libignition-gazebo-ackermann-steering-system.so"}) {
    const DriveGuess guess =
        GuessFor(kRearWheels + Steered("a", 0.0, R"(type="continuous">)") + Plugin(file));
    EXPECT_EQ(guess.drive, Drive::kCarLike) << file;
    EXPECT_NEAR(guess.min_turning_radius, 0.8 / std::tan(0.5), 1e-9);
    EXPECT_THAT(GuessFor(Plugin(file)).why,
                AllOf(HasSubstr(file), HasSubstr("drive: car_like with min_turning_radius")));
  }
}

TEST(DriveGuessTest, AFetchsArmSteersNothing) {
  const RobotModel fetch = LoadRobotModel(std::string(HIRES_SOURCE_DIR) + "/urdf/fetch.urdf");
  const DriveGuess guess = GuessDrive(fetch, fetch.links.front().name);
  EXPECT_EQ(guess.drive, Drive::kDifferential);
  EXPECT_THAT(guess.why, HasSubstr("parallel wheels: l_wheel_joint, r_wheel_joint"));
}

TEST(DriveGuessTest, APr2DrivesAnywhere) {
  const RobotModel pr2 = LoadRobotModel(std::string(HIRES_SOURCE_DIR) + "/urdf/pr2_tray.urdf");
  EXPECT_EQ(GuessDrive(pr2, pr2.links.front().name).drive, Drive::kOmnidirectional);
}

}  // namespace
}  // namespace hires::robot::drive_guess_test
