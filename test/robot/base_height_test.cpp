#include "robot/base_height.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hires/base/rng.h"
#include "hires/robot/link_bounds.h"
#include "robot/assumptions.h"
#include "support/rounds.h"
#include "support/temporary_folder.h"

namespace hires::robot::base_height_test {
namespace {

using hires::test_support::Rounds;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// Three boxes one above the other, each a link; `root` is the one that all hang on.
struct Tower {
  double z[3];       // [m] of the links' frames over the lowest shape's underside
  double height[3];  // [m] of the boxes, whose middle is the frame
  double width[3];   // [m]
};

std::string UrdfOf(const Tower& tower, int root) {
  std::string links, joints;
  for (int i = 0; i < 3; ++i) {
    links += fmt::format(
        "<link name='part_{0}'><collision><geometry><box size='{1} {1} {2}'/></geometry>"
        "</collision></link>",
        i, tower.width[i], tower.height[i]);
    if (i == root) continue;
    joints += fmt::format(
        "<joint name='j{0}' type='fixed'><origin xyz='0 0 {1}'/><parent link='part_{2}'/><child "
        "link='part_{0}'/></joint>",
        i, tower.z[i] - tower.z[root], root);
  }
  return "<robot name='tower'>" + links + joints + "</robot>";
}

Tower DrawTower(base::Rng* rng) {
  Tower tower{};
  double top = 0.0;
  for (int i = 0; i < 3; ++i) {
    tower.height[i] = rng->Uniform(0.1, 0.5);
    tower.width[i] = rng->Uniform(0.1, 0.8);
    tower.z[i] = top + 0.5 * tower.height[i];
    top += tower.height[i];
  }
  return tower;
}

TEST(StandOnFloorTest, NothingDependsOnWhichLinkIsTheRoot) {
  base::Rng rng(1);
  const hires::test_support::TemporaryFolder folder;
  for (int i = 0; i < Rounds(100); ++i) {
    const Tower tower = DrawTower(&rng);
    const Robot first = LoadRobotFromUrdf(folder.Write("r0.urdf", UrdfOf(tower, 0)));
    for (int root = 0; root < 3; ++root) {
      const Robot robot = LoadRobotFromUrdf(folder.Write("r.urdf", UrdfOf(tower, root)));
      EXPECT_NEAR(robot.base_height, tower.z[root], 1e-9);
      EXPECT_NEAR(LowestShape(LinkBounds(robot)), 0.0, 1e-9);
      ASSERT_EQ(robot.profile.footprint.size(), first.profile.footprint.size());
      for (std::size_t k = 0; k < first.profile.footprint.size(); ++k)
        EXPECT_TRUE(robot.profile.footprint[k].isApprox(first.profile.footprint[k], 1e-9));
      const auto X_R = ForwardKinematics(robot.model, {});
      for (int part = 0; part < 3; ++part) {
        const int link = *robot.model.FindLink(fmt::format("part_{}", part));
        EXPECT_NEAR(X_R[link].translation.z(), tower.z[part], 1e-9);
      }
      EXPECT_THAT(robot.assumed, Contains(HasSubstr("so it is so high over the floor")));
    }
  }
}

TEST(StandOnFloorTest, ARootOnTheFloorStaysTheBase) {
  const hires::test_support::TemporaryFolder folder;
  const std::string urdf =
      "<robot name='r'><link name='base'><collision><origin xyz='0 0 0.299'/><geometry><box "
      "size='0.4 0.4 0.6'/></geometry></collision></link></robot>";
  const Robot robot = LoadRobotFromUrdf(folder.Write("r.urdf", urdf));
  EXPECT_EQ(robot.profile.base_link, "base");
  EXPECT_EQ(robot.base_height, 0.0);
}

constexpr char kArmed[] = R"(<robot name="armed">
  <link name="base"><collision><origin xyz="0 0 0.3"/><geometry><box size="0.4 0.4 0.6"/></geometry></collision></link>
  <joint name="shoulder" type="revolute"><origin xyz="0.1 0.2 0.5"/><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <link name="arm"><collision><origin xyz="0 0.4 0"/><geometry><box size="0.06 0.8 0.06"/></geometry></collision></link>
  <joint name="m" type="fixed"><origin xyz="0 0 2.5"/><parent link="base"/><child link="mast"/></joint>
  <link name="mast"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
  <joint name="l" type="fixed"><parent link="base"/><child link="eye"/></joint>
  <link name="eye"/>
  <gazebo reference="eye"><sensor type="gpu_ray" name="s"/></gazebo>
</robot>)";

TEST(AssumptionsTest, APartThatMakesTheFootprintMuchLongerIsNamed) {
  const hires::test_support::TemporaryFolder folder;
  const auto assumed_of = [&](double length, double width) {
    return LoadRobotFromUrdf(
               folder.Write(
                   "long.urdf",
                   fmt::format(
                       R"(<robot name="long"><link name="base"><collision><origin xyz="0 0 0.2"/><geometry><box size="0.9 0.6 0.4"/></geometry></collision></link>
  <joint name="j" type="fixed"><origin xyz="0 0 0.6"/><parent link="base"/><child link="imu"/></joint>
  <link name="imu"><collision><geometry><box size="{} {} 0.1"/></geometry></collision></link></robot>)",
                       length, width)))
        .assumed;
  };
  EXPECT_THAT(assumed_of(8.2, 0.1),
              Contains(AllOf(HasSubstr("8.20 m long and 0.60 m wide, and 'base' reaches farthest"),
                             HasSubstr("'imu' alone makes it 7.30 m longer"))));
  EXPECT_THAT(assumed_of(1.2, 0.1), Not(Contains(HasSubstr("longer"))));
  EXPECT_THAT(assumed_of(8.2, 1.0), Contains(HasSubstr("'imu' reaches farthest to a side;")));
}

TEST(AssumptionsTest, WhatNoFileSaysIsSaidWithWhatToWrite) {
  const hires::test_support::TemporaryFolder folder;
  const std::string urdf = folder.Write("armed.urdf", kArmed);
  const Robot bare = LoadRobotFromUrdf(urdf);
  EXPECT_THAT(bare.assumed, Contains(HasSubstr("'arm' reaches farthest to a side")));
  EXPECT_THAT(bare.assumed, Contains(HasSubstr("over the floor: mast")));
  EXPECT_THAT(bare.assumed, Contains(HasSubstr("`joints: {shoulder: ..}`")));
  EXPECT_THAT(bare.assumed, Contains(HasSubstr("`laser_link: eye`")));
  EXPECT_THAT(bare.assumed, Contains(HasSubstr("motion_sets, base_controller")));
  const Robot told = LoadRobot(folder.Write(
      "armed.yaml",
      "urdf: armed.urdf\njoints: {shoulder: 1.5}\nlaser_link: eye\nfootprint: [{x: 0.3, y: 0.3}, "
      "{x: -0.3, y: 0.3}, {x: -0.3, y: -0.3}, {x: 0.3, y: -0.3}]\nmotion_sets: {slow: "
      "{max_linear_velocity: 0.3, max_angular_velocity: 1, max_linear_acceleration: 1, "
      "max_angular_acceleration: 1}}\nbase_controller: {drive: differential}\n"));
  EXPECT_THAT(told.assumed, Not(Contains(HasSubstr("joints:"))));
  EXPECT_THAT(told.assumed, Not(Contains(HasSubstr("laser_link"))));
  EXPECT_THAT(told.assumed, Not(Contains(HasSubstr("footprint: "))));
  EXPECT_THAT(told.assumed, Not(Contains(HasSubstr("motion_sets"))));
}

}  // namespace
}  // namespace hires::robot::base_height_test
