#include "hires/simulation/free_start.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "simulation/arm_scene.h"
#include "support/rounds.h"

namespace hires::simulation::free_start_test {
namespace {

using test_arm::Pr2;
using test_arm::ReadyState;

/// A post that stands in the way of a stretched right arm after some 0.25 m, of the base later.
std::shared_ptr<const Scene> SceneWithPost() {
  world::World room = test_support::Room();
  room.statics = {test_support::Block("post", {0.1, 0.1, 1.6}, {1.2, test_arm::kToolY, 0.8})};
  return MakeScene(room, Pr2());
}

Variation Shifted(double x, double y, double yaw) {
  Variation variation;
  variation.start_offset = {x, y, yaw};
  variation.wheel_slip = 0.01;
  return variation;
}

void ExpectOffset(const Variation& variation, double x, double y, double yaw) {
  EXPECT_EQ(variation.start_offset.x, x);
  EXPECT_EQ(variation.start_offset.y, y);
  EXPECT_EQ(variation.start_offset.yaw, yaw);
  EXPECT_EQ(variation.wheel_slip, 0.01) << "all else stays as drawn";
}

TEST(FreeStartTest, AnOffsetThatTouchesNothingStays) {
  ExpectOffset(WithFreeStart(Shifted(-0.4, 0.1, 0.02), *SceneWithPost(), ReadyState()), -0.4, 0.1,
               0.02);
}

TEST(FreeStartTest, AnOffsetIntoAThingIsHalvedUntilItTouchesNothing) {
  robot::RobotState driving;  // the base ends 0.34 m before its origin
  ExpectOffset(WithFreeStart(Shifted(1.2, 0.0, 0.01), *SceneWithPost(), driving), 0.6, 0.0, 0.005);
}

TEST(FreeStartTest, WhatTheJointsReachCounts) {
  const auto scene = SceneWithPost();
  ExpectOffset(WithFreeStart(Shifted(0.4, 0.0, 0.0), *scene, {}), 0.4, 0.0, 0.0);
  ExpectOffset(WithFreeStart(Shifted(0.4, 0.0, 0.0), *scene, ReadyState()), 0.2, 0.0, 0.0);
}

TEST(FreeStartTest, ARobotThatTouchesSomethingAnywayHasNoOffset) {
  robot::RobotState start;
  start.X_MB = {1.2, test_arm::kToolY, 0.0};
  ExpectOffset(WithFreeStart(Shifted(0.02, 0.0, 0.1), *SceneWithPost(), start), 0.0, 0.0, 0.0);
}

// ------------------------------------------------------------------------- places on the tray

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kHigh = 0.7;  // [m] height of a tray that nothing else of the robot comes near

/// The plate is 0.25 x 0.50 m. Tilted round the robot's y axis.
std::shared_ptr<const Scene> WithTray(const geometry::Pose3& X_TO, double tilt = 0.0) {
  robot::Robot robot = test_support::TrayRobot();
  robot.model.links[1].joint->X_PJ = {{0.3, 0.0, kHigh}, geometry::RotationFromRpy(0.0, tilt, 0.0)};
  robot.profile.X_TO = X_TO;
  world::World room = test_support::Room();
  world::ObjectModel corner = test_support::Mill("corner");  // its origin is on its rim
  for (geometry::Collision& shape : corner.collisions) shape.X_BS.translation.x() += 0.037;
  test_support::AddModel(&room, corner);
  return MakeScene(room, robot);
}

std::string WhyOff(const Scene& scene, const std::string& model) {
  const robot::RobotState start = test_support::StandingAt({2.0, 2.0, 0.7});
  world::ObjectState object;
  object.name = "load";
  object.model = model;
  object.X_MO = geometry::Lift(start.X_MB) * scene.X_BO;
  try {
    RefuseOffTray(scene, start, object);
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(RefuseOffTrayTest, APlaceIsRefusedWhereNothingCarriesTheMiddleOfTheThing) {
  base::Rng rng(11);
  int beside = 0, above = 0, below = 0, good = 0;
  for (int round = 0; round < hires::test_support::Rounds(1200); ++round) {
    const geometry::Pose3 X_TO =
        geometry::Lift({rng.Uniform(-0.2, 0.2), rng.Uniform(-0.4, 0.4), rng.Uniform(-3.0, 3.0)},
                       rng.Uniform(-0.15, 0.15));
    const std::string model = rng.Bernoulli(0.5) ? "mill" : "corner";
    const Eigen::Vector3d middle = X_TO * Eigen::Vector3d(model == "mill" ? 0.0 : 0.037, 0.0, 0.0);
    const auto is_over = [](const Eigen::Vector3d& p) {
      return std::abs(p.x()) < 0.125 && std::abs(p.y()) < 0.25;
    };
    const std::string why = WhyOff(*WithTray(X_TO), model);
    const bool is_beside = !is_over(middle) && !is_over(X_TO.translation);
    if (std::abs(middle.z()) < 0.06 && !is_beside) {
      EXPECT_EQ(why, "");
      ++good;
      continue;
    }
    EXPECT_THAT(why, AllOf(HasSubstr("object 'load' would begin"), HasSubstr("object_on_tray"),
                           HasSubstr("(-0.125, -0.250, -0.020) to (0.125, 0.250, 0.000) m")));
    EXPECT_THAT(why, HasSubstr(is_beside          ? "m beside the tray's plate"
                               : middle.z() > 0.0 ? "m above the top of the tray's plate"
                                                  : "m below the top of the tray's plate"));
    ++(is_beside ? beside : middle.z() > 0.0 ? above : below);
  }
  EXPECT_GT(std::min({beside, above, below, good}), 10);
}

TEST(RefuseOffTrayTest, HowFarBesideIsSaid) {
  EXPECT_THAT(WhyOff(*WithTray(geometry::Lift({0.0, 0.31, 0.0})), "mill"),
              AllOf(HasSubstr("0.060 m beside"), HasSubstr("is (0.000, 0.310, 0.000) m")));
}

TEST(RefuseOffTrayTest, ATiltedPlateIsNamed) {
  base::Rng rng(12);
  for (int round = 0; round < hires::test_support::Rounds(400); ++round) {
    const double tilt = rng.Uniform(-1.2, 1.2);
    const geometry::Pose3 at_rest = geometry::Lift({rng.Uniform(-0.1, 0.1), 0.0, 0.0});
    geometry::Pose3 upright;  // over the highest edge of the plate, as where no place is given
    upright.rotation = geometry::RotationFromRpy(0.0, -tilt, 0.0);
    upright.translation =
        upright.rotation * Eigen::Vector3d(0.0, 0.0, 0.125 * std::sin(std::abs(tilt)));
    const std::string why = WhyOff(*WithTray(at_rest, tilt), "mill");
    const std::string tilted = fmt::format("is tilted by {:.2f} rad", std::abs(tilt));
    if (std::abs(tilt) < 0.02) {
      EXPECT_EQ(why, "") << tilt;
    }
    if (std::abs(tilt) < 0.09) continue;  // it may begin at rest
    for (const geometry::Pose3& place : {at_rest, upright}) {
      EXPECT_THAT(WhyOff(*WithTray(place, tilt), "mill"),
                  AllOf(HasSubstr(tilted), HasSubstr("object_on_tray")))
          << tilt;
    }
  }
}

TEST(RefuseOffTrayTest, OtherPartsOfTheRobotCarryToo) {
  // 0.02 m above the box of the base, 0.35 m beside and below the plate.
  const auto scene = WithTray({{-0.3, 0.2, 0.32 - kHigh}, Eigen::Quaterniond::Identity()});
  EXPECT_EQ(WhyOff(*scene, "mill"), "");
}

/// Mills of some radii one after the other on a plate with a rim of 0.08 m on all four sides.
struct Load {
  Load(double length, double width, double yaw = 0.0, bool has_rim = true)
      : robot(test_support::TrayRobot()) {
    robot::Link& tray = robot.model.links[1];
    tray.joint->X_PJ = {{0.6, 0.0, kHigh}, geometry::RotationFromRpy(0.0, 0.0, yaw)};
    tray.collisions = {
        test_support::Shape("plate", geometry::Box{{length, width, 0.02}}, {0.0, 0.0, -0.01})};
    for (const double side : {1.0, -1.0}) {
      if (!has_rim) break;
      tray.collisions.push_back(test_support::Shape("rim", geometry::Box{{0.01, width, 0.08}},
                                                    {side * (0.5 * length - 0.005), 0.0, 0.04}));
      tray.collisions.push_back(test_support::Shape("rim", geometry::Box{{length, 0.01, 0.08}},
                                                    {0.0, side * (0.5 * width - 0.005), 0.04}));
    }
    robot.profile.X_TO = {};
  }

  void Add(double radius) {
    test_support::AddModel(&room,
                           test_support::Mill(fmt::format("mill{}", radii.size()), 0.2, radius));
    radii.push_back(radius);
  }

  /// Their places from that of the first, as far as there is room; each of the later ones wants to
  /// stand 0.13 m to the side.
  /// @param are_carried  of the later ones; or null
  std::vector<Eigen::Vector3d> Places(std::vector<bool>* are_carried = nullptr) const {
    const auto scene = MakeScene(room, robot);
    const robot::RobotState start = test_support::StandingAt({2.0, 2.0, 0.7});
    const geometry::Pose3 X_MT = geometry::Lift(start.X_MB) * scene->X_BO;
    std::vector<world::ObjectState> objects;
    std::vector<Eigen::Vector3d> places;
    for (std::size_t i = 0; i < radii.size(); ++i) {
      world::ObjectState object;
      object.name = object.model = fmt::format("mill{}", i);
      const double y = i == 0 ? 0.0 : i == 1 ? -0.13 : 0.13;
      object.X_MO = X_MT * geometry::Lift({0.0, y, 0.0});
      if (i > 0) {
        const auto place = FreeOnTray(*scene, start, object, objects);
        if (!place) break;
        object.X_MO = place->X_MO;
        if (are_carried) are_carried->push_back(place->is_carried);
      }
      objects.push_back(object);
      places.push_back((X_MT.Inverse() * object.X_MO).translation);
    }
    return places;
  }

  robot::Robot robot;
  world::World room{test_support::Room()};
  std::vector<double> radii;
};

TEST(FreeOnTrayTest, ItsOwnPlaceIsKeptWhereItIsFree) {
  Load load(0.3, 0.5);
  for (int i = 0; i < 3; ++i) load.Add(0.04);
  const std::vector<Eigen::Vector3d> places = load.Places();
  ASSERT_EQ(places.size(), 3U);
  EXPECT_NEAR(places[1].y(), -0.13, 1e-9);
  EXPECT_NEAR(places[2].y(), 0.13, 1e-9);
}

TEST(FreeOnTrayTest, WhatNoPlaceCarriesIsTold) {
  Load load(0.12, 0.28, 0.0, false);
  for (int i = 0; i < 2; ++i) load.Add(0.05);
  std::vector<bool> are_carried;
  const std::vector<Eigen::Vector3d> places = load.Places(&are_carried);
  ASSERT_EQ(places.size(), 2U);
  EXPECT_NEAR(places[1].y(), -0.13, 1e-9);
  EXPECT_EQ(are_carried, std::vector<bool>{false});
  Load smaller(0.12, 0.28, 0.0, false);
  for (int i = 0; i < 2; ++i) smaller.Add(0.03);
  are_carried.clear();
  smaller.Places(&are_carried);
  EXPECT_EQ(are_carried, std::vector<bool>{true});
}

// They would begin beside the plate, or with more than a half over its edge, and fall by
// themselves.
TEST(FreeOnTrayTest, OnATurnedPlateWithoutARimAllOfThemIsCarried) {
  base::Rng rng(18);
  int num_moved = 0;
  for (int round = 0; round < hires::test_support::Rounds(40); ++round) {
    const double length = rng.Uniform(0.4, 0.6), width = rng.Uniform(0.16, 0.3);
    Load load(length, width, rng.Uniform(-3.0, 3.0), false);
    for (int i = 0; i < 3; ++i) load.Add(rng.Uniform(0.02, 0.05));
    const std::vector<Eigen::Vector3d> places = load.Places();
    SCOPED_TRACE(fmt::format("round {}: {:.3f} x {:.3f} m", round, length, width));
    ASSERT_EQ(places.size(), 3U);
    for (std::size_t i = 1; i < 3; ++i) {
      const bool is_own = std::abs(std::abs(places[i].y()) - 0.13) < 1e-9;
      const double carried = (is_own ? 0.46 : 0.99) * load.radii[i];
      num_moved += is_own ? 0 : 1;
      EXPECT_LT(std::abs(places[i].x()) + carried, 0.5 * length);
      EXPECT_LT(std::abs(places[i].y()) + carried, 0.5 * width);
    }
  }
  EXPECT_GT(num_moved, 0);
}

TEST(FreeOnTrayTest, OnAnyTrayThingsStandClearOfRimAndEachOtherOrAreLeftOut) {
  base::Rng rng(17);
  int num_moved = 0, num_left_out = 0;
  for (int round = 0; round < hires::test_support::Rounds(60); ++round) {
    const double length = rng.Uniform(0.15, 0.5), width = rng.Uniform(0.15, 0.5);
    Load load(length, width);
    for (int i = 0; i < 3; ++i) load.Add(rng.Uniform(0.02, 0.06));
    const std::vector<Eigen::Vector3d> places = load.Places();
    SCOPED_TRACE(fmt::format("round {}: {:.3f} x {:.3f} m", round, length, width));
    for (std::size_t i = 1; i < places.size(); ++i) {
      const double radius = load.radii[i];
      const bool is_moved = std::abs(places[i].x()) > 1e-9;
      num_moved += is_moved ? 1 : 0;
      const double slack = is_moved ? -0.009 : 0.006;  // [m] what begins in something is freed
      EXPECT_LT(std::abs(places[i].x()) + radius, 0.5 * length - 0.01 + slack);
      EXPECT_LT(std::abs(places[i].y()) + radius, 0.5 * width - 0.01 + slack);
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_GT((places[i] - places[j]).norm(), radius + load.radii[j] - slack);
    }
    num_left_out += places.size() < 3 ? 1 : 0;
    // A cell of the square round the largest thing and its room, on each side of the middle.
    const double cell = 2.0 * (*std::max_element(load.radii.begin(), load.radii.end()) + 0.02);
    const bool has_room =
        std::min(length, width) - 0.02 > cell && std::max(length, width) - 0.02 > 3.0 * cell;
    EXPECT_TRUE(!has_room || places.size() == 3U);
  }
  EXPECT_GT(num_moved, 0);
  EXPECT_GT(num_left_out, 0);
}

}  // namespace
}  // namespace hires::simulation::free_start_test
