#include "robot/urdf/floor_support.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hires::robot::floor_support_test {
namespace {

std::string Link(const std::string& name, double mass, const std::string& shape) {
  return fmt::format(
      "<link name='{0}'><inertial><mass value='{1}'/><inertia ixx='0.1' ixy='0' ixz='0' iyy='0.1' "
      "iyz='0' izz='0.1'/></inertial><collision>{2}</collision></link>",
      name, mass, shape);
}

std::string WheelAt(const std::string& name, const std::string& parent, double x, double y,
                    double z, double radius) {
  return Link(name, 1.0,
              fmt::format("<origin rpy='1.5707963267949 0 0'/><geometry><cylinder radius='{}' "
                          "length='0.04'/></geometry>",
                          radius)) +
         fmt::format(
             "<joint name='{0}_joint' type='continuous'><origin xyz='{2} {3} {4}'/><parent "
             "link='{1}'/><child link='{0}'/><axis xyz='0 1 0'/></joint>",
             name, parent, x, y, z);
}

Robot RobotOf(const std::string& parts) {
  const std::string body = Link("base", 60.0,
                                "<origin xyz='0 0 0.18'/><geometry><box size='0.8 0.5 0.16'/>"
                                "</geometry>");
  Robot robot;
  robot.model = ParseRobotModel("<robot name='r'>" + body + parts + "</robot>", "test.urdf");
  robot.profile.base_link = "base";
  robot.profile.footprint = {{-0.4, -0.3}, {0.4, -0.3}, {0.4, 0.3}, {-0.4, 0.3}};
  return robot;
}

const std::string kTwoWheels =
    WheelAt("left", "base", 0.1, 0.28, 0.1, 0.1) + WheelAt("right", "base", 0.1, -0.28, 0.1, 0.1);

TEST(FloorSupportTest, TwoWheelsLeaveTheFootprintToBeAssumed) {
  const FloorSupport support = FloorSupportOf(RobotOf(kTwoWheels), {});
  EXPECT_EQ(support.num_contacts, 2);
  EXPECT_TRUE(support.is_assumed);
  EXPECT_EQ(support.polygon.size(), 4u);
  EXPECT_DOUBLE_EQ(support.wheel_radius.value(), 0.1);
  EXPECT_DOUBLE_EQ(support.body.value().mass, 62.0);
}

TEST(FloorSupportTest, CasterBallMakesATriangle) {
  const std::string ball = Link("ball", 0.5, "<geometry><sphere radius='0.03'/></geometry>") +
                           "<joint name='b' type='fixed'><origin xyz='-0.3 0 0.03'/><parent "
                           "link='base'/><child link='ball'/></joint>";
  const FloorSupport support = FloorSupportOf(RobotOf(kTwoWheels + ball), {});
  EXPECT_EQ(support.num_contacts, 3);
  EXPECT_FALSE(support.is_assumed);
  double front = -1.0, rear = 1.0, side = 0.0;
  for (const Eigen::Vector2d& corner : support.polygon) {
    front = std::max(front, corner.x());
    rear = std::min(rear, corner.x());
    side = std::max(side, corner.y());
  }
  EXPECT_NEAR(front, 0.1, 1e-9);
  EXPECT_NEAR(rear, -0.3, 1e-9);
  EXPECT_NEAR(side, 0.28, 1e-9);
}

TEST(FloorSupportTest, WheelWhoseShapeEndsHigherRollsOnTheHeightOfItsAxis) {
  const FloorSupport support =
      FloorSupportOf(RobotOf(WheelAt("left", "base", 0.0, 0.28, 0.1, 0.07) +
                             WheelAt("right", "base", 0.0, -0.28, 0.1, 0.07)),
                     {});
  EXPECT_DOUBLE_EQ(support.wheel_radius.value(), 0.1);
}

TEST(FloorSupportTest, WheelsInOneLineBearNothing) {
  const FloorSupport support =
      FloorSupportOf(RobotOf(kTwoWheels + WheelAt("middle", "base", 0.1, 0.0, 0.1, 0.1)), {});
  EXPECT_EQ(support.num_contacts, 3);
  EXPECT_TRUE(support.is_assumed);
}

std::string CartOn(const std::string& joint, double trail) {
  return Link("cart", 40.0,
              fmt::format("<origin xyz='{} 0 0.25'/><geometry><box size='0.5 0.4 0.1'/></geometry>",
                          -trail)) +
         fmt::format(
             "<joint name='{}' type='continuous'><origin xyz='-0.5 0 0'/><parent "
             "link='base'/><child link='cart'/><axis xyz='0 0 1'/></joint>",
             joint) +
         WheelAt("cart_left", "cart", -trail, 0.2, 0.08, 0.08) +
         WheelAt("cart_right", "cart", -trail, -0.2, 0.08, 0.08);
}

TEST(FloorSupportTest, TowedCartIsNamedAndBearsNothing) {
  const FloorSupport support = FloorSupportOf(RobotOf(kTwoWheels + CartOn("swivel", 0.5)), {});
  EXPECT_THAT(support.towed, testing::ElementsAre("cart"));
  EXPECT_EQ(support.num_contacts, 2);
  EXPECT_DOUBLE_EQ(support.body.value().mass, 62.0);
}

TEST(FloorSupportTest, CasterIsNoCartUnlessItsJointIsCalledHitch) {
  EXPECT_TRUE(FloorSupportOf(RobotOf(kTwoWheels + CartOn("swivel", 0.05)), {}).towed.empty());
  EXPECT_EQ(FloorSupportOf(RobotOf(kTwoWheels + CartOn("hitch", 0.05)), {}).towed.size(), 1u);
}

TEST(FloorSupportTest, Pr2StandsOnEightWheels) {
  const Robot pr2 = LoadRobot(HIRES_SOURCE_DIR "/config/robots/pr2.yaml");
  const FloorSupport support = FloorSupportOf(pr2, pr2.profile.joints);
  EXPECT_EQ(support.num_contacts, 8);
  EXPECT_FALSE(support.is_assumed);
  EXPECT_TRUE(support.towed.empty());
  EXPECT_NEAR(support.wheel_radius.value(), 0.079, 0.002);
  EXPECT_GT(support.body.value().mass, 150.0);
}

}  // namespace
}  // namespace hires::robot::floor_support_test
