#include "robot/tray_place.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "hires/base/rng.h"
#include "hires/robot/load_robot.h"
#include "support/rounds.h"
#include "support/temporary_folder.h"

namespace hires::robot::tray_place_test {
namespace {

using hires::test_support::Rounds;
using hires::test_support::TemporaryFolder;
using ::testing::Contains;
using ::testing::HasSubstr;

/// A box on wheels with a tray 0.6 x 0.4 m at 0.5 m, and what stands on it.
std::string Waiter(const std::string& on_tray) {
  return "<robot name='waiter'><link name='base'><collision><origin xyz='0 0 0.25'/><geometry><box "
         "size='0.5 0.5 0.48'/></geometry></collision></link>\n<link name='tray'><collision>"
         "<geometry><box size='0.6 0.4 0.02'/></geometry></collision></link>\n<joint name='t' "
         "type='fixed'><origin xyz='0 0 0.5'/><parent link='base'/><child link='tray'/></joint>\n" +
         on_tray + "</robot>";
}

std::string Thing(const std::string& name, double x, double y, double z, const std::string& shape) {
  return fmt::format(
      "<link name='{0}'><collision><geometry>{1}</geometry></collision></link>\n<joint "
      "name='j_{0}' "
      "type='fixed'><origin xyz='{2} {3} {4}'/><parent link='tray'/><child link='{0}'/></joint>\n",
      name, shape, x, y, z);
}

TEST(PlaceOnTrayTest, AFreeMiddleIsThePlace) {
  const RobotModel model = ParseRobotModel(
      Waiter(Thing("mast", 0.25, 0.0, 0.2, "<cylinder radius='0.02' length='0.4'/>") +
             Thing("camera", 0.0, 0.0, 0.8, "<box size='0.1 0.1 0.1'/>")),
      "waiter.urdf");
  const TrayPlace place = PlaceOnTray(model, {}, "tray");
  EXPECT_EQ(place.taken_by, "");
  EXPECT_TRUE(place.X_TO.translation.isApprox(Eigen::Vector3d(0.0, 0.0, 0.01), 1e-9));
}

TEST(PlaceOnTrayTest, ATakenMiddleGivesWayToTheLargestFreePart) {
  const RobotModel model = ParseRobotModel(
      Waiter(Thing("lidar", -0.1, 0.0, 0.05, "<cylinder radius='0.15' length='0.08'/>")),
      "waiter.urdf");
  const TrayPlace place = PlaceOnTray(model, {}, "tray");
  EXPECT_EQ(place.taken_by, "lidar");
  EXPECT_TRUE(place.is_free);
  // Ahead of the lidar, between its front at 0.05 and the edge at 0.30.
  EXPECT_NEAR(place.X_TO.translation.x(), 0.17, 0.02);
  EXPECT_NEAR(place.X_TO.translation.z(), 0.01, 1e-9);
  EXPECT_GT(place.radius, 0.12);
}

TEST(PlaceOnTrayTest, AFullTrayIsSaidToBe) {
  const RobotModel model = ParseRobotModel(
      Waiter(Thing("crate", 0.0, 0.0, 0.1, "<box size='0.6 0.4 0.18'/>")), "waiter.urdf");
  EXPECT_FALSE(PlaceOnTray(model, {}, "tray").is_free);
}

TEST(PlaceOnTrayTest, WhateverStandsThereThePlaceIsFreeAndNoWorseThanAGridFinds) {
  base::Rng rng(27);
  int num_moved = 0;
  for (int round = 0; round < Rounds(60); ++round) {
    struct Box {
      double x, y, half_x, half_y;
    };
    std::vector<Box> boxes;
    std::string things;
    const int num_things = 1 + rng.Index(3);
    for (int i = 0; i < num_things; ++i) {
      const Box box{rng.Uniform(-0.25, 0.25), rng.Uniform(-0.15, 0.15), rng.Uniform(0.02, 0.12),
                    rng.Uniform(0.02, 0.12)};
      boxes.push_back(box);
      things += Thing(fmt::format("thing{}", i), box.x, box.y, 0.06,
                      fmt::format("<box size='{} {} 0.1'/>", 2 * box.half_x, 2 * box.half_y));
    }
    const auto radius_at = [&](double x, double y) {
      double least = std::min({0.3 - std::abs(x), 0.2 - std::abs(y)});
      for (const Box& box : boxes) {
        const double dx = std::max(0.0, std::abs(x - box.x) - box.half_x);
        const double dy = std::max(0.0, std::abs(y - box.y) - box.half_y);
        least = std::min(least, std::hypot(dx, dy));
      }
      return least;
    };
    double best = 0.0;
    for (double x = -0.3; x <= 0.3; x += 0.01) {
      for (double y = -0.2; y <= 0.2; y += 0.01) best = std::max(best, radius_at(x, y));
    }
    const TrayPlace place = PlaceOnTray(ParseRobotModel(Waiter(things), "w.urdf"), {}, "tray");
    const Eigen::Vector3d& p = place.X_TO.translation;
    if (place.taken_by.empty()) {
      EXPECT_GE(radius_at(0.0, 0.0), 0.05 - 1e-9);
      continue;
    }
    ++num_moved;
    EXPECT_NEAR(radius_at(p.x(), p.y()), place.radius, 2e-3);
    EXPECT_GE(place.radius, best - 0.01) << things;
  }
  EXPECT_GT(num_moved, 5);
}

TEST(PlaceOnTrayTest, TheRobotSaysWhereThingsStandAndWhy) {
  const TemporaryFolder folder;
  folder.Write("w.urdf",
               Waiter(Thing("lidar", 0.0, 0.0, 0.05, "<cylinder radius='0.1' length='0.08'/>")));
  for (const std::string& path :
       {(folder.path() / "w.urdf").string(), folder.Write("w.yaml", "urdf: w.urdf\n"),
        folder.Write("t.yaml", "urdf: w.urdf\ntray_link: tray\n")}) {
    const Robot robot = LoadAnyRobot(path);
    EXPECT_THAT(robot.assumed, Contains(HasSubstr("as 'lidar' takes the middle")));
    EXPECT_GT(robot.profile.X_TO.translation.norm(), 0.1);
  }
  const Robot told = LoadAnyRobot(folder.Write(
      "o.yaml", "urdf: w.urdf\nobject_on_tray: {xyz: [0.2, 0.1, 0.01], rpy: [0, 0, 0]}\n"));
  EXPECT_EQ(told.profile.X_TO.translation, Eigen::Vector3d(0.2, 0.1, 0.01));
}

TEST(IsMotionAssumedTest, FollowsWhatTheFilesSay) {
  const TemporaryFolder folder;
  folder.Write("w.urdf", Waiter(""));
  const std::string set =
      "{max_linear_velocity: 1, max_angular_velocity: 1, max_linear_acceleration: 1, "
      "max_angular_acceleration: 1}";
  EXPECT_TRUE(IsMotionAssumed((folder.path() / "w.urdf").string()));
  EXPECT_TRUE(IsMotionAssumed(folder.Write("a.yaml", "urdf: w.urdf\n")));
  EXPECT_TRUE(IsMotionAssumed(
      folder.Write("b.yaml", "urdf: w.urdf\nbase_controller: {drive: differential}\n")));
  EXPECT_FALSE(IsMotionAssumed(
      folder.Write("c.yaml", "urdf: w.urdf\nbase_controller: {limits: " + set + "}\n")));
  EXPECT_FALSE(
      IsMotionAssumed(folder.Write("d.yaml", "urdf: w.urdf\nmotion_sets: {slow: " + set + "}\n")));
}

}  // namespace
}  // namespace hires::robot::tray_place_test
