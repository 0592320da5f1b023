#include "skills/look_skills.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "hires/geometry/angles.h"
#include "hires/robot/posture.h"
#include "hires/skills/base_place.h"
#include "hires/skills/head_aim.h"
#include "restaurant.h"

namespace hires::skills::look_skills_test {
namespace {

using Eigen::Vector3d;
using test_support::Frame;
using test_support::On;
using test_support::Played;
using test_support::Rehearsal;
using test_support::RobotAt;
using test_support::TheRestaurant;
using test_support::UpperBody;

const char kAtCounter[] = "manipulationAreaEastCounter1";
const char kCounter[] = "placingAreaEastRightCounter1";

robot::RobotState AtCounter() {
  return RobotAt(kAtCounter, "torsoupposture", "armtuckedposture", "armtosideposture");
}

Eigen::AlignedBox2d Square(double half_width) {
  return {Eigen::Vector2d::Constant(-half_width), Eigen::Vector2d::Constant(half_width)};
}

const robot::Robot& Pr2() { return TheRestaurant().scene->robot; }

/// [rad] between the camera's axis and a point.
double AngleOff(const robot::JointPositions& joints, const geometry::Pose2& X_MB,
                const Vector3d& p_M) {
  const Vector3d p_C =
      perception::ViewOf(Pr2(), X_MB, PostureOf(Pr2(), joints)).X_MC.Inverse() * p_M;
  return std::atan2(p_C.tail<2>().norm(), p_C.x());
}

TEST(AimHeadTest, BringsPointsAllAroundOntoTheCamerasAxis) {
  robot::JointPositions joints = AtCounter().joints;
  for (const double heading : {-2.0, -1.0, 0.0, 0.5, 1.5, 2.5}) {
    for (const double height : {0.4, 0.75, 1.5}) {
      const Vector3d p(1.5 * std::cos(heading), 1.5 * std::sin(heading), height);
      const auto aim = AimHead(Pr2(), {}, PostureOf(Pr2(), joints), p);
      ASSERT_TRUE(aim.has_value());
      joints[UpperBody().head_pan_joint] = aim->at(0);
      joints[UpperBody().head_tilt_joint] = aim->at(1);
      EXPECT_LT(AngleOff(joints, {}, p), 2e-4) << heading << " " << height;
    }
  }
}

TEST(AimHeadTest, FindsNothingForWhatTheHeadCannotTurnTo) {
  const robot::JointPositions posture = PostureOf(Pr2(), AtCounter().joints);
  EXPECT_FALSE(AimHead(Pr2(), {}, posture, {0.3, 0.0, 6.0}).has_value());  // over its head
}

TEST(LookAtTest, TheHeadRestsOnAnArea) {
  Rehearsal rehearsal(AtCounter(), {});
  const Played played = rehearsal.Play({"look_at", {kCounter}});
  EXPECT_EQ(ToString(played.status.failure), "");
  const robot::RobotState now = rehearsal.simulator().GetRobotState();
  EXPECT_LT(AngleOff(now.joints, now.X_MB, Frame(kCounter).translation), 0.03);
  EXPECT_GE(played.duration, TheRestaurant().skills.manipulation->params.look.dwell);
}

TEST(LookAtTest, TheHeadTurnsToARememberedObject) {
  Rehearsal rehearsal(AtCounter(), {On("mug1", kCounter, 0.05, -0.1)});
  ASSERT_EQ(ToString(rehearsal.Play({"look_at", {kCounter}}).status.failure), "");
  rehearsal.Wait(1.0);
  EXPECT_EQ(ToString(rehearsal.Play({"look_at", {"Mug1"}}).status.failure), "");
  const robot::RobotState now = rehearsal.simulator().GetRobotState();
  EXPECT_LT(AngleOff(now.joints, now.X_MB, rehearsal.ObjectNow("mug1").X_MO.translation), 0.03);
}

TEST(LookAtTest, AnObjectThatNobodyKnowsIsNotSeen) {
  Rehearsal rehearsal(AtCounter(), {});
  EXPECT_EQ(ToString(rehearsal.Play({"look_at", {"mug1"}}).status.failure), "object_not_seen");
}

TEST(ObserveObjectsOnAreaTest, EndsWithEverythingThatStandsThere) {
  Rehearsal rehearsal(AtCounter(),
                      {On("mug1", kCounter, 0.1, 0.1), On("mug2", kCounter, -0.1, -0.1),
                       On("book1", "placingAreaWestLeftTable1")});
  EXPECT_EQ(ToString(rehearsal.Play({"observe_objects_on_area", {kCounter}}).status.failure), "");
  std::vector<std::string> names;
  for (const robot::SeenObject& object : rehearsal.simulator().Observe(0.0).objects) {
    names.push_back(object.name);
    EXPECT_LT((object.X_MO.translation - rehearsal.ObjectNow(object.name).X_MO.translation).norm(),
              0.01);
  }
  EXPECT_THAT(names, ::testing::ElementsAre("mug1", "mug2"));
}

TEST(ObserveObjectsOnAreaTest, AnEmptyAreaIsSeenEmpty) {
  Rehearsal rehearsal(AtCounter(), {});
  EXPECT_EQ(ToString(rehearsal.Play({"observe_objects_on_area", {kCounter}}).status.failure), "");
  EXPECT_TRUE(rehearsal.simulator().Observe(0.0).objects.empty());
}

TEST(ObserveObjectsOnAreaTest, AnAreaAcrossTheRoomIsOutOfView) {
  Rehearsal rehearsal(AtCounter(), {});  // table2: beyond the camera's range
  EXPECT_EQ(ToString(rehearsal.Play({"observe_objects_on_area", {"placingAreaNorthLeftTable2"}})
                         .status.failure),
            "out_of_view");
}

/// A mug on the counter with something so much higher before it [m].
std::vector<world::ObjectState> MugBehind(double height) {
  world::ObjectState screen = On("mug1", kCounter, 0.10);
  screen.name = "screen";
  screen.model = fmt::format("unknown_0.030x0.200x{:.3f}", height);
  return {On("mug1", kCounter, -0.08), screen};
}

/// The robot knows of the mug, and looks for it from somewhere.
Played LookFrom(const std::string& torso, const std::string& place, double height,
                robot::RobotState* now = nullptr) {
  const std::vector<world::ObjectState> objects = MugBehind(height);
  Rehearsal rehearsal(AtCounter(), objects);
  rehearsal.simulator().Remember({{"mug1", objects[0].model, objects[0].X_MO, 0.0, ""}});
  const Played played =
      rehearsal.Play({"observe_objects_at", {kCounter, kAtCounter, torso, place}});
  if (now != nullptr) *now = rehearsal.simulator().GetRobotState();
  return played;
}

void ExpectAsBefore(const robot::RobotState& now) {
  const robot::RobotState before = AtCounter();
  EXPECT_LT((now.X_MB.position() - before.X_MB.position()).norm(), 0.035);
  EXPECT_LT(std::abs(geometry::WrapToPi(now.X_MB.yaw - before.X_MB.yaw)), 0.035);
  const std::string& torso = UpperBody().torso_joint;
  EXPECT_NEAR(now.joints.at(torso), before.joints.at(torso), 0.01);
}

TEST(ObserveObjectsAtTest, TheRobotStandsAfterwardsAsItStoodBefore) {
  robot::RobotState now;
  const Played played = LookFrom("torsomiddleposture", "left", 0.05, &now);
  EXPECT_EQ(ToString(played.status.failure), "");
  EXPECT_THAT(played.phases, ::testing::IsSupersetOf({"drive", "torso", "sweep", "return_base"}));
  ExpectAsBefore(now);
  double farthest = 0.0;
  for (const robot::Command& command : played.commands)
    if (command.base_velocity) farthest = std::max(farthest, std::abs(command.base_velocity->vy));
  EXPECT_GT(farthest, 0.1) << "it went to the side";
}

TEST(ObserveObjectsAtTest, WhatIsHiddenFromAPoseIsNotSeenThereAndTheRobotComesBackAllTheSame) {
  robot::RobotState now;
  const Played hidden = LookFrom("torsodownposture", "behind", 0.24, &now);
  EXPECT_EQ(ToString(hidden.status.failure), "object_not_seen: mug1");
  ExpectAsBefore(now);
  EXPECT_EQ(ToString(LookFrom("torsoupposture", "default", 0.24).status.failure), "");
}

TEST(ObserveObjectsAtTest, WhatIsGoneIsNotSeenAndWhereNothingIsExpectedLookingIsEnough) {
  const base::ActionCall look{"observe_objects_at",
                              {kCounter, kAtCounter, "torsoupposture", "default"}};
  Rehearsal gone(AtCounter(), {});
  const world::ObjectState mug = On("mug1", kCounter);
  gone.simulator().Remember({{"mug1", mug.model, mug.X_MO, 0.0, ""}});
  EXPECT_EQ(ToString(gone.Play(look).status.failure), "object_not_seen: mug1");
  Rehearsal empty(AtCounter(), {});
  const world::ObjectState elsewhere = On("mug2", "placingAreaWestLeftTable1");
  empty.simulator().Remember({{"mug2", elsewhere.model, elsewhere.X_MO, 0.0, ""}});
  EXPECT_EQ(ToString(empty.Play(look).status.failure), "");
}

TEST(AtBasePlaceTest, IsMeantInTheFrameOfTheStand) {
  const geometry::Pose2 X_MStand{1.0, 2.0, geometry::kPi / 2};
  const geometry::Pose2 left = AtBasePlace(X_MStand, "Left"),
                        behind = AtBasePlace(X_MStand, "behind");
  EXPECT_LT((left.position() - Eigen::Vector2d(0.8, 2.0)).norm(), 1e-12);
  EXPECT_LT((behind.position() - Eigen::Vector2d(1.0, 1.8)).norm(), 1e-12);
  EXPECT_EQ(left.yaw, X_MStand.yaw);
}

/// A wide square close by needs several looks; every part has been in view at rest afterwards.
TEST(SweepPointsTest, LooksUntilEveryPartHasBeenInView) {
  const std::shared_ptr<const ManipulationContext>& context = TheRestaurant().skills.manipulation;
  const robot::RobotState robot = AtCounter();
  const geometry::Pose3 X_MF{{5.1, 10.1, 0.75}, Eigen::Quaterniond::Identity()};
  const std::vector<Vector3d> points = PointsOn(X_MF, Square(0.6), 0.2);
  SweepPoints sweep(context, points);
  std::vector<bool> seen_at_rest(points.size(), false);
  robot::Observation seen;
  seen.X_MB = robot.X_MB;
  seen.joints = PostureOf(Pr2(), robot.joints);
  Status status;
  int looks = 0;
  for (int cycle = 0; cycle < 4000 && status.progress == Progress::kRunning; ++cycle) {
    seen.time = 0.05 * cycle;
    robot::Command command;
    status = sweep.Update(seen, &command);
    // The head is there at once, but the skill waits as long as its own trajectory takes.
    for (const auto& [group, trajectory] : command.trajectories) {
      SetJoints(trajectory.joints, trajectory.points.back().positions, &seen.joints);
      ++looks;
    }
    const perception::CameraView view = perception::ViewOf(Pr2(), seen.X_MB, seen.joints);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (view.Contains(points[i])) seen_at_rest[i] = true;
    }
  }
  EXPECT_EQ(status.progress, Progress::kSucceeded) << ToString(status.failure);
  EXPECT_GT(looks, 1);
  EXPECT_LT(looks, 20);
  EXPECT_THAT(seen_at_rest, ::testing::Each(true));
}

TEST(PointsOnTest, ALongAreaIsCoveredToItsEnds) {
  const auto points = PointsOn({{1.0, 2.0, 0.7}, Eigen::Quaterniond::Identity()},
                               {Eigen::Vector2d(-0.14, -0.44), Eigen::Vector2d(0.14, 0.14)}, 0.07);
  EXPECT_EQ(points.size(), 5u * 10u);  // 7 steps to the far end, 2 to each near one
  EXPECT_LT((points.front() - Vector3d(1.0, 2.0, 0.7)).norm(), 1e-12);
  EXPECT_NEAR((points.back() - Vector3d(1.0, 2.0, 0.7)).norm(), std::hypot(0.14, 0.44), 1e-12);
}

TEST(PointsOnTest, CoverTheSquareWithItsRimsTheMiddleFirst) {
  const auto points =
      PointsOn({{1.0, 2.0, 0.7}, Eigen::Quaterniond::Identity()}, Square(0.175), 0.07);
  EXPECT_EQ(points.size(), 49u);  // 7 x 7, 0.058 apart
  EXPECT_LT((points.front() - Vector3d(1.0, 2.0, 0.7)).norm(), 1e-12);
  EXPECT_NEAR((points.back() - Vector3d(1.0, 2.0, 0.7)).norm(), 0.175 * std::sqrt(2.0), 1e-12);
}

}  // namespace
}  // namespace hires::skills::look_skills_test
