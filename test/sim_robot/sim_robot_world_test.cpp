#include "sim_robot/sim_robot_world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hires/simulation/truth_record.h"
#include "support/messages.h"
#include "support/scenes.h"

namespace hires::sim_robot::sim_robot_world_test {
namespace {

using geometry::Pose2;
using ::testing::HasSubstr;

robot::Command Drive(double vx) {
  robot::Command command;
  command.base_velocity = geometry::Twist2{vx, 0.0, 0.0};
  return command;
}

class SimRobotWorldTest : public ::testing::Test {
 protected:
  static imagination::ImaginationSetup Setup(const std::string& uncertainty = "none") {
    imagination::ImaginationSetup setup;
    setup.scene = hires::test_support::RoomScene();
    setup.skills = std::make_shared<const skills::SkillSet>(skills::MakeSkillSet(
        hires::test_support::Room(), hires::test_support::TrayRobot(), {}, {}));
    setup.uncertainty = std::make_shared<const imagination::Uncertainty>(
        imagination::UncertaintyFromText(uncertainty, "test"));
    setup.object_models = {{"mill1", "mill"}};
    setup.translator.object_models = setup.object_models;
    setup.translator.world = {setup.scene, &setup.scene->world};
    setup.translator.robot = {setup.scene, &setup.scene->robot};
    return setup;
  }
  static imagination::StartState Start() {
    const Pose2 X_MB{1.0, 2.0, 0.0};
    imagination::StartState start;
    start.robot.X_MB = X_MB;
    start.world.objects = {hires::test_support::OnTray("mill1", "mill", X_MB)};
    return start;
  }
  /// Drives ahead for some ticks, as somebody who commands at 10 Hz.
  static void DriveAhead(int ticks, SimRobotWorld* world) {
    for (int tick = 0; tick < ticks; ++tick) {
      if (tick % 2 == 0) world->Apply(Drive(0.3));
      world->Advance(50);
    }
  }
};

constexpr char kUncertain[] = R"(
object_mass: {distribution: uniform, lower: 0.8, upper: 1.2, unit: factor, source: test}
start_x: {distribution: uniform, lower: -0.1, upper: 0.1, unit: m, source: test}
localisation_x: {distribution: normal, mean: 0.0, sd: 0.015, unit: m, source: test}
localisation_noise: {distribution: fixed, value: 0.002, unit: m, source: test}
wheel_slip: {distribution: uniform, lower: 0.01, upper: 0.03, unit: share, source: test}
late_cycle_probability: {distribution: fixed, value: 0.2, unit: share, source: test}
late_cycle_delay: {distribution: uniform, lower: 0.3, upper: 0.5, unit: s, source: test}
)";

TEST_F(SimRobotWorldTest, WithoutUncertaintyTheSensorsTellTheTruth) {
  SimRobotWorld world(Setup(), Start(), 1);
  DriveAhead(40, &world);
  const SensorReadings readings = world.Sense();
  const Pose2& X_MB = world.simulator().base().X_MB;
  EXPECT_GT(X_MB.x, 1.5);
  EXPECT_NEAR(readings.X_MB.x, X_MB.x, 1e-12);
  const Pose2 by_odometry = readings.X_MO * readings.odometry.X_OB;
  EXPECT_NEAR(by_odometry.x, X_MB.x, 1e-9);
  EXPECT_NEAR(readings.X_MO.x, 1.0, 1e-6);  // odometry has not drifted
}

TEST_F(SimRobotWorldTest, TheSameSeedIsTheSameTruthBitByBit) {
  SimRobotWorld a(Setup(kUncertain), Start(), 7), b(Setup(kUncertain), Start(), 7);
  SimRobotWorld c(Setup(kUncertain), Start(), 8);
  for (SimRobotWorld* world : {&a, &b, &c}) DriveAhead(40, world);
  EXPECT_EQ(a.simulator().base().X_MB.x, b.simulator().base().X_MB.x);
  EXPECT_EQ(a.Sense().X_MB.x, b.Sense().X_MB.x);
  EXPECT_NE(a.simulator().base().X_MB.x, c.simulator().base().X_MB.x);
}

TEST_F(SimRobotWorldTest, OdometryDriftsAndIsCorrectedByThePlace) {
  SimRobotWorld world(Setup(kUncertain), Start(), 7);
  const double before = world.Sense().X_MO.x;
  DriveAhead(80, &world);
  const SensorReadings readings = world.Sense();
  EXPECT_GT(std::abs(readings.X_MO.x - before), 1e-4);
  EXPECT_NEAR((readings.X_MO * readings.odometry.X_OB).x, readings.X_MB.x, 1e-9);
}

TEST_F(SimRobotWorldTest, ACommandCycleThatComesLateLetsTheBaseBrake) {
  constexpr char kLate[] = R"(
late_cycle_probability: {distribution: fixed, value: 1.0, unit: share, source: test}
late_cycle_delay: {distribution: fixed, value: 0.5, unit: s, source: test}
)";
  SimRobotWorld late(Setup(kLate), Start(), 1), punctual(Setup(), Start(), 1);
  for (SimRobotWorld* world : {&late, &punctual}) DriveAhead(40, world);
  EXPECT_LT(late.simulator().base().X_MB.x, punctual.simulator().base().X_MB.x - 0.1);
}

TEST_F(SimRobotWorldTest, APushMovesTheRobotWithItsLoadAndOdometryFeelsNothing) {
  SimRobotWorld world(Setup(), Start(), 1);
  const Pose2 odometry = world.Sense().odometry.X_OB;
  ASSERT_EQ(world.Push({0.0, 0.5, 0.0}), "");
  EXPECT_NEAR(world.simulator().base().X_MB.y, 2.5, 1e-9);
  const auto state = world.simulator().GetWorldState();
  EXPECT_NEAR(state.Find("mill1")->X_MO.translation.y(), 2.5, 1e-3);
  EXPECT_EQ(world.Sense().odometry.X_OB.y, odometry.y);
  EXPECT_NEAR(world.Sense().X_MB.y, 2.5, 1e-9);
}

TEST_F(SimRobotWorldTest, APushIntoAWallIsRefusedAndChangesNothing) {
  SimRobotWorld world(Setup(), Start(), 1);
  EXPECT_THAT(world.Push({-1.0, 0.0, 0.0}), HasSubstr("west_wall"));
  EXPECT_THAT(world.Push({std::nan(""), 0.0, 0.0}), HasSubstr("not finite"));
  EXPECT_NEAR(world.simulator().base().X_MB.x, 1.0, 1e-9);
}

TEST_F(SimRobotWorldTest, ObjectsGoAndComeAndFall) {
  SimRobotWorld world(Setup(), Start(), 1);
  simulation::TruthRecord truth{{}};
  truth.Look(world.simulator());
  ASSERT_EQ(world.Drop("Mill1"), "");
  for (int i = 0; i < 200; ++i) {
    world.Advance(10);
    truth.Look(world.simulator());
  }
  EXPECT_EQ(truth.falls(), 1);
  EXPECT_GT(truth.objects().at("mill1").max_tilt, 0.5);
  ASSERT_EQ(world.Remove("mill1"), "");
  EXPECT_TRUE(world.simulator().GetWorldState().objects.empty());
  EXPECT_THAT(world.Remove("mill1"), HasSubstr("mill1"));
  ASSERT_EQ(world.Place("Tower1", "tower", geometry::Lift({3.0, 1.0, 0.0})), "");
  EXPECT_NE(world.simulator().GetWorldState().Find("tower1"), nullptr);
  EXPECT_THAT(world.Place("vase1", "", {}), HasSubstr("vase1"));
  EXPECT_THAT(world.Place("vase1", "mill", geometry::Lift({3.0, 0.0, 0.0})),
              HasSubstr("south_wall"));
}

TEST_F(SimRobotWorldTest, AnObjectThatStaysUpHasNotFallen) {
  SimRobotWorld world(Setup(), Start(), 1);
  simulation::TruthRecord truth{{}};
  for (int tick = 0; tick < 20; ++tick) {
    world.Apply(Drive(0.1));
    world.Advance(50);
    truth.Look(world.simulator());
  }
  EXPECT_EQ(truth.falls(), 0);
  EXPECT_NEAR(truth.distance(), world.simulator().base().X_MB.x - 1.0, 0.01);
  EXPECT_EQ(truth.contact(), "");
}

TEST(StartOfTest, ScenariosOfThePackageHaveAStart) {
  const std::string config = std::string(HIRES_SOURCE_DIR) + "/config/";
  const auto setup =
      imagination::LoadImaginationSetup(imagination::ReadSetupConfig(config + "scene.yaml"));
  const auto start = StartOf(setup, config + "scenarios/serve_coffee.yaml", "");
  EXPECT_NE(start.world.Find("book1"), nullptr);
  EXPECT_NEAR(start.robot.X_MB.x, 12.5, 1e-9);
  EXPECT_NEAR(start.robot.joints.at("l_elbow_flex_joint"), -2.05, 1e-9);
  EXPECT_THAT(hires::test_support::ConfigErrorOf([&] { StartOf(setup, "", "nowhere"); }),
              HasSubstr("nowhere"));
}

/// All that a world does in 20 s of standing and driving.
Truth Eventful() {
  Truth truth;
  truth.name = "eventful";
  truth.bumps = {3.0, 0.2, 0.3, 0.25};
  truth.walk = {0.02, 0.01, 5.0};
  return truth;
}

TEST_F(SimRobotWorldTest, TheSameSeedIsTheSameUnderEveryTruth) {
  SimRobotWorld a(Setup(kUncertain), Start(), 7, Eventful());
  SimRobotWorld b(Setup(kUncertain), Start(), 7, Eventful());
  SimRobotWorld same(Setup(kUncertain), Start(), 7), named(Setup(kUncertain), Start(), 7, Truth{});
  for (SimRobotWorld* world : {&a, &b, &same, &named}) DriveAhead(100, world);
  EXPECT_EQ(a.simulator().base().X_MB.x, b.simulator().base().X_MB.x);
  EXPECT_EQ(a.Sense().X_MB.x, b.Sense().X_MB.x);
  EXPECT_NE(a.simulator().base().X_MB.x, same.simulator().base().X_MB.x);
  EXPECT_EQ(named.simulator().base().X_MB.x, same.simulator().base().X_MB.x);
}

TEST_F(SimRobotWorldTest, ABumpChangesTheTwistOfABaseThatStands) {
  Truth truth;
  truth.bumps = {2.0, 0.2, 0.3, 0.25};
  truth.controller = {{"loop_frequency", 20.0}, {"loop_damping", 0.7}};
  SimRobotWorld world(Setup(), Start(), 1, truth);
  double fastest = 0.0;
  for (int i = 0; i < 1000; ++i) {  // 10 s
    world.Advance(10);
    const geometry::Twist2& V_B = world.simulator().base().V_B;
    fastest = std::max(fastest, std::hypot(V_B.vx, V_B.vy));
  }
  EXPECT_GT(fastest, 0.02);
  EXPECT_LT(fastest, 0.3);
}

TEST_F(SimRobotWorldTest, ASillShakesWhatStandsOnTheTray) {
  const auto largest_tilt = [](const Truth& truth) {
    SimRobotWorld world(Setup(), Start(), 1, truth);
    double largest = 0.0;
    for (int tick = 0; tick < 60; ++tick) {
      world.Apply(Drive(0.3));
      for (int i = 0; i < 5; ++i) {
        world.Advance(10);
        const auto X_MO = world.simulator().GetWorldState().objects.front().X_MO;
        if (tick > 30) largest = std::max(largest, geometry::TiltOf(X_MO.rotation));
      }
    }
    return largest;
  };
  Truth truth;
  truth.floor.sills = {{{1.6, 0.0}, {1.6, 4.0}, 0.04, 0.004}};
  EXPECT_GT(largest_tilt(truth), largest_tilt(Truth{}) + 0.003);
}

TEST_F(SimRobotWorldTest, LocalisationThatWalksIsOffByItsSpread) {
  Truth truth;
  truth.walk = {0.02, 0.0, 1.0};
  SimRobotWorld world(Setup(), Start(), 1, truth);
  double sum = 0.0;
  for (int i = 0; i < 2000; ++i) {
    world.Advance(50);
    const double error = world.Sense().X_MB.x - world.simulator().base().X_MB.x;
    sum += error * error / 2000.0;
  }
  EXPECT_NEAR(std::sqrt(sum), 0.02, 0.006);  // 100 s are about 50 independent values
}

TEST_F(SimRobotWorldTest, ImaginationIsGivenTheSameForEveryTruth) {
  const imagination::ImaginationSetup imagined = Setup(kUncertain);
  const auto scene = imagined.scene;
  const double frequency = scene->robot.profile.base_controller.loop_frequency;
  Truth truth = Eventful();
  truth.controller["loop_frequency"] = 11.0;
  truth.changes["object_mass"] = {imagination::Distribution::Kind::kFixed, 2.0, 0.0};
  truth.floor.patches = {{{1.0, 2.0}, 1.0, 0.5}};
  const SimRobotWorld world(imagined, Start(), 1, truth);
  EXPECT_EQ(world.scene()->robot.profile.base_controller.loop_frequency, 11.0);
  EXPECT_NE(world.scene(), scene);
  EXPECT_EQ(imagined.scene, scene);
  EXPECT_EQ(scene->robot.profile.base_controller.loop_frequency, frequency);
  EXPECT_TRUE(scene->floor.patches.empty());
  EXPECT_EQ(imagined.uncertainty->quantities.at("object_mass").first, 0.8);
}

TEST_F(SimRobotWorldTest, FurnitureIsMovedForTheRobotAloneAndNeverOntoIt) {
  const imagination::ImaginationSetup imagined = Setup();
  const world::StaticBody& body = imagined.scene->world.statics[1];
  Truth truth;
  truth.moved = {{body.name, {-0.5, 0.0, 0.0}, 1.0}};
  const SimRobotWorld moved(imagined, Start(), 1, truth);
  EXPECT_NEAR(moved.scene()->world.statics[1].X_MB.translation.x(), body.X_MB.translation.x() - 0.5,
              1e-12);
  const Pose2 to_robot{Start().robot.X_MB.x - body.X_MB.translation.x(),
                       Start().robot.X_MB.y - body.X_MB.translation.y(), 0.0};
  truth.moved.front().by = to_robot;
  const SimRobotWorld kept(imagined, Start(), 1, truth);
  EXPECT_EQ(kept.scene()->world.statics[1].X_MB.translation, body.X_MB.translation);
  truth.moved.front().body = "sofa";
  EXPECT_THAT(
      hires::test_support::ConfigErrorOf([&] { SimRobotWorld(imagined, Start(), 1, truth); }),
      HasSubstr("static body 'sofa' is unknown"));
}

TEST_F(SimRobotWorldTest, FurnitureThatWasMovedIsThereToBeTouched) {
  Truth truth;
  truth.moved = {{"east_wall", {-2.5, 0.0, 0.0}, 1.0}};  // its face is at x = 3.5 m then
  SimRobotWorld moved(Setup(), Start(), 1, truth), same(Setup(), Start(), 1);
  for (SimRobotWorld* world : {&moved, &same}) DriveAhead(180, world);
  ASSERT_TRUE(moved.simulator().contact());
  EXPECT_EQ(moved.simulator().contact()->obstacle, "east_wall");
  EXPECT_FALSE(same.simulator().contact());
}

}  // namespace
}  // namespace hires::sim_robot::sim_robot_world_test
