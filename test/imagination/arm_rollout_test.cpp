// Rollouts of what arms and torso do, in the restaurant.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <thread>

#include "hires/geometry/angles.h"
#include "hires/imagination/evidence.h"
#include "hires/imagination/local_imagination.h"
#include "hires/imagination/rollout.h"
#include "hires/perception/recogniser_config.h"
#include "imagination/restaurant_rollouts.h"
#include "support/messages.h"

namespace hires::imagination::arm_rollout_test {
namespace {

using hires::test_support::ConfigErrorOf;
using test_support::MugBeforeTable;
using test_support::Occupants;
using test_support::ReadyAt;
using test_support::Restaurant;
using test_support::Rollouts;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr char kPlacingArea[] = "placingAreaWestRightTable1";
const base::ActionCall kPlace{"place_object", {"mug1", "rightArm1", kPlacingArea}};
const base::ActionCall kPick{"pick_up_object", {"mug1", "rightArm1"}};

RolloutResult Play(const RolloutSetup& setup, const base::ActionCall& action, int index = 0) {
  const auto result = PlayRollout(setup, action, index);
  EXPECT_TRUE(result) << "nobody cancelled it";
  return result.value_or(RolloutResult());
}

StartState MugOnCounter() {
  std::vector<base::Atom> atoms = ReadyAt("manipulationAreaEastCounter1");
  atoms.push_back({"On", {"mug1", "placingAreaEastRightCounter1"}});
  return MakeStartState(Restaurant(), atoms);
}

// ---------------------------------------------------------------------------- what comes out

/// The area's back is taken, so of two spots imagination must take the one in front, though it was
/// asked for last.
TEST(ArmRolloutTest, ASpotThatSomethingTakesUpIsNotChosen) {
  const world::World& world = Restaurant().scene->world;
  const geometry::Pose3 X_MA = *world.FindFrame(kPlacingArea);
  const geometry::Pose3 X_MBowl = X_MA * geometry::Lift(geometry::Pose2{-0.10, 0.0, 0.0});
  const RolloutSetup setup = Rollouts(MugBeforeTable({{"bowl1", "", X_MBowl}}));
  const auto at = [](const std::string& spot) {
    return base::ActionCall{"place_object_at", {"mug1", "rightArm1", kPlacingArea, spot}};
  };
  SchedulerParams params;
  params.rollouts = 2;
  params.criteria.min_success = 0.1;
  const Report report = ImagineLocally(setup, {at("back"), at("front")}, params, 2);
  ASSERT_EQ(report.ranking.size(), 2u);
  EXPECT_EQ(report.recommended, 0) << report.why;
  EXPECT_TRUE(report.ranking[0].action == at("front")) << report.why;
  EXPECT_EQ(report.ranking[0].evidence.success.share, 1.0);
  EXPECT_EQ(report.ranking[1].evidence.success.share, 0.0);
  EXPECT_EQ(report.ranking[1].evidence.failures.begin()->first.code,
            base::FailureCode::kAreaOccupied);
}

/// A menu card stands before the mug: from the place where the robot stands nothing of it is seen,
/// from its left more than enough. With the torso down the counter is too near for the camera.
TEST(ArmRolloutTest, ThePoseThatSeesWhatIsExpectedIsChosenAndTheOthersSayWhyNot) {
  constexpr char kCounter[] = "placingAreaEastRightCounter1",
                 kStand[] = "manipulationAreaEastCounter1";
  const auto on_counter = [&](const std::string& object, double x, double y, double yaw) {
    return PutObject{object, "", geometry::Lift({x, y, yaw}, 0.75)};
  };
  const StartState start =
      MakeStartState(Restaurant(), ReadyAt(kStand),
                     {on_counter("mug1", 5.39, 10.075, 0.0),
                      on_counter("menucard1", 5.50, 10.16, geometry::kPi / 2)});
  const auto from = [&](const std::string& torso, const std::string& place) {
    return base::ActionCall{"observe_objects_at", {kCounter, kStand, torso, place}};
  };
  SchedulerParams params;
  params.rollouts = 2;
  params.criteria.min_success = 0.1;
  const Report report =
      ImagineLocally(Rollouts(start),
                     {from("torsoupposture", "default"), from("torsodownposture", "default"),
                      from("torsoupposture", "left")},
                     params, 2);
  ASSERT_EQ(report.ranking.size(), 3u);
  EXPECT_EQ(report.recommended, 0) << report.why;
  EXPECT_TRUE(report.ranking[0].action == from("torsoupposture", "left")) << report.why;
  EXPECT_EQ(report.ranking[0].evidence.success.share, 1.0);
  std::set<std::string> failures;
  for (const int other : {1, 2}) {
    EXPECT_EQ(report.ranking[other].evidence.success.share, 0.0);
    failures.insert(ToString(report.ranking[other].evidence.failures.begin()->first));
  }
  EXPECT_THAT(failures, ::testing::ElementsAre("object_not_seen: mug1", "out_of_view"));
}

TEST(ArmRolloutTest, AMugIsPutOnAFreeTable) {
  const RolloutResult result = Play(Rollouts(MugBeforeTable()), kPlace);
  EXPECT_EQ(result.outcome, Outcome::kSucceeded) << ToString(result.failure);
  EXPECT_FALSE(result.nothing_watched);
  EXPECT_NEAR(result.counts.total(), 20.0 * result.duration, 1.0);
  EXPECT_EQ(result.falls, 0);
  const world::ObjectState& mug = *result.final_world.Find("mug1");
  EXPECT_EQ(mug.attached_to, "");
  EXPECT_LT(geometry::TiltOf(mug.X_MO.rotation), 0.01);
  const geometry::Pose3 X_MArea = *Restaurant().scene->world.FindFrame(kPlacingArea);
  EXPECT_LT((mug.X_MO.translation - X_MArea.translation).head<2>().norm(), 0.05);
  EXPECT_NEAR(mug.X_MO.translation.z(), X_MArea.translation.z(), 0.003);
}

TEST(ArmRolloutTest, OnAnOccupiedTableItFailsWithTheNamesOfWhatIsThere) {
  const RolloutResult result = Play(Rollouts(MugBeforeTable(Occupants())), kPlace);
  EXPECT_EQ(result.outcome, Outcome::kFailed);
  EXPECT_EQ(ToString(result.failure), "area_occupied: book1, book2, bowl1");
  EXPECT_FALSE(result.action_finished);
  EXPECT_EQ(RolloutConfidence(result), 0.0);
  EXPECT_EQ(result.final_world.Find("mug1")->attached_to, "r_gripper_palm_link");
}

TEST(ArmRolloutTest, WithUncertaintyTheOccupiedTableStillFailsAndTheFreeOneSucceeds) {
  const RolloutSetup occupied = Rollouts(MugBeforeTable(Occupants()), "config");
  const RolloutSetup free = Rollouts(MugBeforeTable(), "config");
  for (int index = 0; index < 4; ++index) {
    EXPECT_THAT(ToString(Play(occupied, kPlace, index).failure), HasSubstr("area_occupied: "))
        << index;
    EXPECT_EQ(ToString(Play(free, kPlace, index).failure), "") << index;
  }
}

TEST(ArmRolloutTest, WhatIsPickedUpIsHeld) {
  const RolloutResult result = Play(Rollouts(MugOnCounter()), kPick);
  EXPECT_EQ(result.outcome, Outcome::kSucceeded) << ToString(result.failure);
  EXPECT_EQ(result.final_world.Find("mug1")->attached_to, "r_gripper_palm_link");
  EXPECT_GT(result.counts.notopple, 0) << "it stands at first";
}

/// With a recogniser that looks at pictures instead of the quick detector.
TEST(ArmRolloutTest, AMugIsPickedUpByWhatTheCameraMeasures) {
  const std::string config = HIRES_SOURCE_DIR "/config/recogniser.yaml";
  const auto by = [&](std::vector<perception::KnownModel> known) {
    RolloutSetup setup = Rollouts(MugOnCounter());
    auto scene = std::make_shared<simulation::Scene>(*setup.scene);
    scene->sight.recogniser = std::make_shared<const perception::Recogniser>(
        known, perception::ReadRecogniserConfig(config).params);
    setup.scene = scene;
    return Play(setup, kPick);
  };
  std::vector<perception::KnownModel> known = perception::ReadRecogniserConfig(config).catalogue;
  const RolloutResult result = by(known), again = by(known);
  EXPECT_EQ(result.outcome, Outcome::kSucceeded) << ToString(result.failure);
  EXPECT_EQ(result.final_world.Find("mug1")->attached_to, "r_gripper_palm_link");
  EXPECT_EQ(result.duration, again.duration);
  EXPECT_EQ(result.final_world.Find("mug1")->X_MO.translation,
            again.final_world.Find("mug1")->X_MO.translation);
  const auto is_cup = [](const auto& one) { return one.label.find("cup") != std::string::npos; };
  known.erase(std::remove_if(known.begin(), known.end(), is_cup), known.end());
  EXPECT_NE(by(known).outcome, Outcome::kSucceeded) << "nothing like a mug is known";
}

TEST(ArmRolloutTest, WhatIsNotThereCannotBePickedUp) {
  const StartState start = MakeStartState(Restaurant(), ReadyAt("manipulationAreaEastCounter1"));
  const RolloutResult result = Play(Rollouts(start), kPick);
  EXPECT_EQ(ToString(result.failure), "object_not_seen");
  EXPECT_TRUE(ActionFailed(result));
}

TEST(ArmRolloutTest, OneStepsFinalStateIsTheNextOnesStart) {
  const RolloutResult picked = Play(Rollouts(MugOnCounter(), "config"), kPick, 1);
  ASSERT_EQ(ToString(picked.failure), "");
  const base::ActionCall to_side{"move_arm_to_side", {"rightArm1"}};
  const RolloutSetup next = Rollouts({picked.final_world, picked.final_robot}, "config");
  EXPECT_NO_THROW(CheckSetup(next, to_side));
  const RolloutResult result = Play(next, to_side);
  EXPECT_EQ(ToString(result.failure), "");
  EXPECT_EQ(result.final_world.Find("mug1")->attached_to, "r_gripper_palm_link");
}

TEST(ArmRolloutTest, OverTheTrayAndBack) {
  std::vector<base::Atom> atoms = ReadyAt("preManipulationAreaEastCounter1");
  atoms.push_back({"Holding", {"rightArm1", "peppermill1"}});
  const RolloutResult put = Play(Rollouts(MakeStartState(Restaurant(), atoms)),
                                 {"place_on_tray", {"rightArm1", "peppermill1"}});
  ASSERT_EQ(ToString(put.failure), "");
  EXPECT_EQ(put.final_world.Find("peppermill1")->attached_to, "");
  const RolloutResult taken = Play(Rollouts({put.final_world, put.final_robot}),
                                   {"pick_up_from_tray", {"rightArm1", "peppermill1"}});
  EXPECT_EQ(ToString(taken.failure), "");
  EXPECT_EQ(taken.final_world.Find("peppermill1")->attached_to, "r_gripper_palm_link");
}

TEST(ArmRolloutTest, WithEmptyHandsSuccessIsAllTheEvidence) {
  std::vector<base::Atom> atoms{{"RobotAt", {"preManipulationAreaEastCounter1"}},
                                {"HasTorsoPosture", {"TorsoDownPosture"}}};
  const RolloutResult result =
      Play(Rollouts(MakeStartState(Restaurant(), atoms)), {"move_torso", {"TorsoMiddlePosture"}});
  EXPECT_EQ(result.outcome, Outcome::kSucceeded) << ToString(result.failure);
  EXPECT_TRUE(result.nothing_watched);
  EXPECT_EQ(result.counts.total(), 0);
  const Evidence evidence = SumUp({result, result});
  EXPECT_EQ(evidence.confidence_pooled, 1.0);
  EXPECT_EQ(evidence.confidence_mean, 1.0);
  EXPECT_EQ(evidence.success.share, 1.0);
  EXPECT_EQ(evidence.max_tilt.p95, 0.0);
}

TEST(ArmRolloutTest, AMugInTheHandDrivesAlong) {
  std::vector<base::Atom> atoms{{"RobotAt", {"preManipulationAreaEastCounter1"}},
                                {"HasArmPosture", {"leftArm1", "ArmCarryPosture"}},
                                {"HasArmPosture", {"rightArm1", "ArmCarryPosture"}},
                                {"Holding", {"rightArm1", "mug1"}}};
  const StartState start = MakeStartState(Restaurant(), atoms);
  const RolloutResult result =
      Play(Rollouts(start), {"move_base_param", {"preManipulationAreaSouthTable1", "slow"}});
  EXPECT_EQ(result.outcome, Outcome::kSucceeded) << ToString(result.failure);
  EXPECT_FALSE(result.nothing_watched);
  const world::ObjectState& mug = *result.final_world.Find("mug1");
  EXPECT_EQ(mug.attached_to, "r_gripper_palm_link");
  const auto from_base = [](const robot::RobotState& robot, const world::ObjectState& object) {
    return geometry::Lift(robot.X_MB).Inverse() * object.X_MO;
  };
  const Eigen::Vector3d before = from_base(start.robot, *start.world.Find("mug1")).translation;
  EXPECT_LT((from_base(result.final_robot, mug).translation - before).norm(), 0.01);
}

// -------------------------------------------------------------------------- seeds and chance

TEST(ArmRolloutTest, TheSameSeedGivesTheSameBitsInAnyThread) {
  const RolloutSetup setup = Rollouts(MugBeforeTable(), "config");
  std::vector<RolloutResult> here, there(2);
  for (int index = 0; index < 2; ++index) here.push_back(Play(setup, kPlace, index));
  std::vector<std::thread> threads;
  for (int index = 0; index < 2; ++index) {
    threads.emplace_back([&, index] { there[index] = *PlayRollout(setup, kPlace, index); });
  }
  for (std::thread& thread : threads) thread.join();
  for (int index = 0; index < 2; ++index) {
    EXPECT_TRUE(SameOutcome(here[index], there[index]));
    EXPECT_TRUE(here[index].final_robot == there[index].final_robot);
    EXPECT_EQ(here[index].final_world.Find("mug1")->X_MO.translation,
              there[index].final_world.Find("mug1")->X_MO.translation);
  }
  EXPECT_FALSE(SameOutcome(here[0], here[1]));
}

/// Where robot and mug are at every sample of a rollout.
struct Trace {
  std::vector<robot::RobotState> robot;
  std::vector<Eigen::Vector3d> mug;
};

TEST(ArmRolloutTest, ARolloutPlaysTheSkillAsALockstepLoopDoes) {
  const RolloutSetup setup = Rollouts(MugBeforeTable());
  Trace imagined;
  PlayRollout(setup, kPlace, 0, {{}, [&](const simulation::RobotSimulator& simulator, double) {
                                   imagined.robot.push_back(simulator.GetRobotState());
                                   imagined.mug.push_back(simulator.PoseOf(0).translation);
                                 }});
  // The same skill, stepped by hand: 0.5 s of settling, then one Update every 50 steps.
  simulation::RobotSimulator simulator(setup.scene, {}, setup.world_state, setup.robot_state,
                                       base::Rng(99), setup.physics,
                                       simulation::LevelOfDetail::kPlanar);
  for (int i = 0; i < 500; ++i) simulator.Step();
  const auto skill = skills::MakeSkill(*setup.skills, kPlace);
  Trace stepped;
  for (;;) {
    robot::Command command;
    const auto status = skill->Update(simulator.Observe(0.5), &command);
    simulator.Send(command);
    if (status.progress != skills::Progress::kRunning) break;
    for (int i = 0; i < 50; ++i) simulator.Step();
    stepped.robot.push_back(simulator.GetRobotState());
    stepped.mug.push_back(simulator.PoseOf(0).translation);
  }
  ASSERT_EQ(imagined.robot.size(), stepped.robot.size());
  for (std::size_t i = 0; i < stepped.robot.size(); ++i) {
    ASSERT_TRUE(imagined.robot[i] == stepped.robot[i]) << "sample " << i;
    ASSERT_EQ(imagined.mug[i], stepped.mug[i]) << "sample " << i;
  }
}

TEST(ArmRolloutTest, AGraspThatIsOffStaysOff) {
  const auto first_pose = [](const std::string& uncertainty) {
    geometry::Pose3 X_LO;
    bool seen = false;
    PlayRollout(Rollouts(MugBeforeTable(), uncertainty), kPlace, 0,
                {[&] { return seen; },
                 [&](const simulation::RobotSimulator& simulator, double) {
                   X_LO = simulator.X_MLink("r_gripper_palm_link").Inverse() * simulator.PoseOf(0);
                   seen = true;
                 }});
    return X_LO;
  };
  const geometry::Pose3 exact = first_pose("none");
  const geometry::Pose3 off = first_pose(
      "grasp_x: {distribution: fixed, value: 0.01, unit: m, source: test}\n"
      "grasp_turn: {distribution: fixed, value: 0.05, unit: rad, source: test}\n");
  EXPECT_NEAR(off.translation.x() - exact.translation.x(), 0.01, 0.002);
  EXPECT_NEAR(exact.rotation.angularDistance(off.rotation), 0.05, 0.002);
}

// ------------------------------------------------------------------------------ bad requests

TEST(ArmCheckSetupTest, RefusesHandsThatHoldMoreThanMakesSense) {
  const auto why_not = [](const StartState& start) {
    return ConfigErrorOf([&] { CheckSetup(Rollouts(start), kPlace); });
  };
  const StartState good = MugBeforeTable();
  EXPECT_NO_THROW(CheckSetup(Rollouts(good), kPlace));

  StartState start = good;
  start.world.objects.push_back(start.world.objects[0]);
  start.world.objects[1].name = "mug2";
  start.world.objects[1].X_MO.translation.z() += 0.2;
  EXPECT_THAT(why_not(start), AllOf(HasSubstr("'mug1' and 'mug2'"), HasSubstr("one object")));

  start = good;
  start.world.objects[0].X_MO.translation.x() += 0.6;
  EXPECT_THAT(why_not(start), AllOf(HasSubstr("object 'mug1' is attached"), HasSubstr("0.5")));

  start = good;
  start.world.objects[0].attached_to = "r_griper_palm_link";
  EXPECT_THAT(why_not(start), HasSubstr("did you mean 'r_gripper_palm_link'"));

  start = good;
  start.world.objects.push_back(start.world.objects[0]);  // in two hands
  start.world.objects[1].attached_to = "l_gripper_palm_link";
  EXPECT_THAT(why_not(start), HasSubstr("object 'mug1' is there twice"));
}

TEST(ArmCheckSetupTest, RefusesJointsBeyondTheirLimits) {
  StartState start = MugBeforeTable();
  start.robot.joints["r_elbow_flex_joint"] = 1.0;  // -2.12 .. -0.15
  EXPECT_THAT(ConfigErrorOf([&] { CheckSetup(Rollouts(start), kPlace); }),
              HasSubstr("r_elbow_flex_joint"));
  start = MugBeforeTable();
  start.robot.joints["r_elbow_joint"] = -1.0;
  EXPECT_THAT(ConfigErrorOf([&] { CheckSetup(Rollouts(start), kPlace); }),
              HasSubstr("r_elbow_joint"));
}

TEST(ArmCheckSetupTest, RefusesUnknownArmsAndAreas) {
  const auto why_not = [](const base::ActionCall& action) {
    return ConfigErrorOf([&] { CheckSetup(Rollouts(MugBeforeTable()), action); });
  };
  EXPECT_THAT(why_not({"place_object", {"mug1", "rightArm2", kPlacingArea}}),
              HasSubstr("rightArm2"));
  EXPECT_THAT(why_not({"place_object", {"mug1", "rightArm1", "moon"}}), HasSubstr("moon"));
  EXPECT_THAT(why_not({"place_object", {"mug1", "rightArm1"}}), HasSubstr("2 arguments, wanted 3"));
}

}  // namespace
}  // namespace hires::imagination::arm_rollout_test
