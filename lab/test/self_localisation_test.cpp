#include "hires/simulation/self_localisation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "hires/base/text.h"
#include "hires/geometry/angles.h"
#include "lab/src/experiment/experiment.h"
#include "sim_robot/sim_robot_world.h"
#include "support/messages.h"
#include "support/scenes.h"
#include "support/temporary_folder.h"

namespace hires::lab::self_localisation_test {
namespace {

using geometry::Pose2;
using hires::test_support::ConfigErrorOf;
using sim_robot::Localisation;
using sim_robot::SensorReadings;
using sim_robot::SimRobotWorld;
using sim_robot::Truth;
using sim_robot::WithoutPlace;
using simulation::SelfLocalisationParams;
using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kConfig = HIRES_SOURCE_DIR "/config";

/// A room with a cupboard, so that its halves differ.
world::World RoomWithCupboard() {
  world::World room = hires::test_support::Room();
  room.statics.push_back(hires::test_support::Block("cupboard", {0.6, 0.4, 1.0}, {3.5, 3.8, 0.5}));
  room.hash = room.ComputeHash();
  return room;
}

imagination::ImaginationSetup SetupOfRoom() {
  static const auto scene =
      simulation::MakeScene(RoomWithCupboard(), robot::LoadRobot(kConfig + "/robots/pr2.yaml"));
  imagination::ImaginationSetup setup;
  setup.scene = scene;
  setup.uncertainty = std::make_shared<const imagination::Uncertainty>(
      imagination::UncertaintyFromText("none", "test"));
  return setup;
}

imagination::StartState Start() {
  imagination::StartState start;
  start.robot.X_MB = {2.5, 1.0, 0.0};
  return start;
}

SelfLocalisationParams ShippedParams() {
  return simulation::LoadSelfLocalisation(kConfig + "/self_localisation.yaml");
}

Truth TruthWith(const SelfLocalisationParams& params) {
  Truth truth;
  truth.localisation = Localisation::kFilter;
  truth.self_localisation = std::make_shared<const SelfLocalisationParams>(params);
  return truth;
}

double Apart(const Pose2& a, const Pose2& b) { return (a.position() - b.position()).norm(); }

struct Course {
  double worst{0.0};           // [m] of the belief
  double worst_odometry{0.0};  // [m] of odometry alone, from where it began
  std::vector<SensorReadings> told;
};

/// To the left in circles of radius 0.75 m, for so many seconds.
Course DriveInCircles(double seconds, SimRobotWorld* world) {
  Course course;
  const Pose2 X_MO = world->simulator().base().X_MB * world->Sense().odometry.X_OB.Inverse();
  const int ticks = static_cast<int>(std::lround(20.0 * seconds));
  for (int tick = 0; tick < ticks; ++tick) {
    robot::Command command;
    command.base_velocity = geometry::Twist2{0.3, 0.0, 0.4};
    world->Apply(command);
    world->Advance(sim_robot::kSensorTick);
    course.told.push_back(world->Sense());
    const Pose2& X_MB = world->simulator().base().X_MB;
    const SensorReadings& told = course.told.back();
    course.worst = std::max(course.worst, Apart(told.X_MB, X_MB));
    course.worst_odometry = std::max(course.worst_odometry, Apart(X_MO * told.odometry.X_OB, X_MB));
  }
  return course;
}

TEST(SelfLocalisationTest, LaserAndFilterKeepThePlaceThatWheelsLose) {
  SelfLocalisationParams params = ShippedParams();
  params.casters.slip = 0.3;  // far more than is shipped
  double worst = 0.0, worst_odometry = 0.0;
  for (const int seed : {1, 2, 3, 4, 5}) {
    SimRobotWorld world(SetupOfRoom(), Start(), seed, TruthWith(params));
    const Course course = DriveInCircles(16.0, &world);
    EXPECT_FALSE(world.simulator().contact());
    EXPECT_LT(course.worst, course.worst_odometry) << seed;
    worst += course.worst / 5.0;
    worst_odometry += course.worst_odometry / 5.0;
  }
  // Measured: 0.142 m and 0.305 m.
  EXPECT_LT(worst, 0.6 * worst_odometry);
  EXPECT_LT(worst, 0.2);
}

TEST(SelfLocalisationTest, ItTellsHowSureItIsAndOneThatIsToldDoesNot) {
  SimRobotWorld finds(SetupOfRoom(), Start(), 1, TruthWith(ShippedParams()));
  SimRobotWorld is_told(SetupOfRoom(), Start(), 1);
  const SensorReadings found = DriveInCircles(2.0, &finds).told.back();
  EXPECT_GT(found.covariance(0, 0), 1e-8);
  EXPECT_LT(found.covariance(0, 0), 0.1);
  EXPECT_EQ(DriveInCircles(2.0, &is_told).told.back().covariance, Eigen::Matrix3d::Zero());
}

TEST(SelfLocalisationTest, TheSameSeedBelievesTheSameBitForBitAndTwiceAtOneMoment) {
  SimRobotWorld a(SetupOfRoom(), Start(), 7, TruthWith(ShippedParams()));
  SimRobotWorld b(SetupOfRoom(), Start(), 7, TruthWith(ShippedParams()));
  SimRobotWorld c(SetupOfRoom(), Start(), 8, TruthWith(ShippedParams()));
  const Course of_a = DriveInCircles(5.0, &a), of_b = DriveInCircles(5.0, &b);
  EXPECT_EQ(of_a.told.back().X_MB.x, of_b.told.back().X_MB.x);
  EXPECT_EQ(of_a.told.back().odometry.X_OB.yaw, of_b.told.back().odometry.X_OB.yaw);
  EXPECT_NE(of_a.told.back().X_MB.x, DriveInCircles(5.0, &c).told.back().X_MB.x);
  EXPECT_EQ(a.Sense().X_MB.x, of_a.told.back().X_MB.x);
}

TEST(SelfLocalisationTest, ASimulatorThatIsRestoredBelievesOnBitForBit) {
  const auto setup = SetupOf(TruthWith(ShippedParams()), SetupOfRoom(), {}, base::Rng(1));
  simulation::RobotSimulator simulator(setup.scene, {}, {}, Start().robot, base::Rng(1), {},
                                       simulation::LevelOfDetail::kPlanar);
  const auto drive_on = [&] {
    Pose2 X_MB;
    for (int tick = 0; tick < 40; ++tick) {
      robot::Command command;
      command.base_velocity = geometry::Twist2{0.4, 0.0, 0.2};
      simulator.Send(command);
      for (int step = 0; step < 50; ++step) simulator.Step();
      X_MB = simulator.Observe(0.0).X_MB;
    }
    return X_MB;
  };
  drive_on();
  const auto snapshot = simulator.Save();
  const Pose2 first = drive_on();
  simulator.Restore(*snapshot);
  const Pose2 again = drive_on();
  EXPECT_EQ(first.x, again.x);
  EXPECT_EQ(first.yaw, again.yaw);
}

/// Nobody tells it; its laser does.
TEST(SelfLocalisationTest, ARobotThatIsCarriedAwayBelievesOnAndBecomesUnsure) {
  SimRobotWorld world(SetupOfRoom(), Start(), 3, TruthWith(ShippedParams()));
  DriveInCircles(4.0, &world);
  const Pose2 before = world.Sense().X_MB;
  const Pose2 X_MBthere{2.5, 2.5, geometry::kPi};
  ASSERT_EQ(world.Push(world.simulator().base().X_MB.Inverse() * X_MBthere), "");
  EXPECT_LT(Apart(world.Sense().X_MB, before), 0.01);
  bool was_lost = false;
  for (int i = 0; i < 8; ++i) {
    DriveInCircles(1.0, &world);
    const auto status = world.simulator().self_localiser()->Estimate().status;
    was_lost |= status != localisation::LocalisationStatus::kGood;
  }
  EXPECT_TRUE(was_lost);
}

TEST(SelfLocalisationTest, ARobotThatIsCarriedFromAnotherPlaceTakesItselfToBeThere) {
  SelfLocalisationParams params = ShippedParams();
  params.mistaken_for = {{2.5, 1.2, 0.0}, {1.0, 3.0, 0.5}};  // the first is too near to be meant
  SimRobotWorld world(SetupOfRoom(), Start(), 3, TruthWith(params));
  EXPECT_LT(Apart(world.simulator().self_localiser()->X_MB(), {1.0, 3.0, 0.0}), 0.2);
  SimRobotWorld again(SetupOfRoom(), Start(), 3, TruthWith(ShippedParams()));
  EXPECT_LT(Apart(again.simulator().self_localiser()->X_MB(), Start().robot.X_MB), 0.2);
}

TEST(SelfLocalisationTest, WheelsSpinOnAWetFloorAndTheLaserMakesUpForIt) {
  SelfLocalisationParams params = ShippedParams();
  params.wet.push_back({{2.5, 1.75}, 2.0, 0.5});
  double worst_dry = 0.0, worst_wet = 0.0, worst_believed = 0.0;
  for (const int seed : {1, 2, 3}) {
    SimRobotWorld wet(SetupOfRoom(), Start(), seed, TruthWith(params));
    SimRobotWorld dry(SetupOfRoom(), Start(), seed, TruthWith(ShippedParams()));
    const Course on_wet = DriveInCircles(8.0, &wet);
    worst_dry = std::max(worst_dry, DriveInCircles(8.0, &dry).worst_odometry);
    worst_wet = std::max(worst_wet, on_wet.worst_odometry);
    worst_believed = std::max(worst_believed, on_wet.worst);
  }
  EXPECT_GT(worst_wet, 5.0 * worst_dry);
  EXPECT_LT(worst_believed, 0.5 * worst_wet);
}

/// What wheels that spin tell of the speed is as wrong as what they tell of the way.
TEST(SelfLocalisationTest, OnAWetFloorTheSpeedIsThatOfTheWheels) {
  const auto told = [](double spin) {
    auto params = std::make_shared<SelfLocalisationParams>(ShippedParams());
    if (spin > 0.0) params->wet.push_back({{0.0, 0.0}, 5.0, spin});
    simulation::MotionSensors sensors(params, {}, base::Rng(3));
    sensors.Drive(0.1, {0.03, 0.0, 0.0});
    const Pose2 X_OB = sensors.odometry().X_OB;
    sensors.Drive(0.1, {0.06, 0.0, 0.0});
    const double way = (X_OB.Inverse() * sensors.odometry().X_OB).x;
    EXPECT_NEAR(sensors.odometry().V_B.vx * 0.1, way, 0.03 * std::abs(way) + 5e-4) << spin;
    return sensors.odometry().V_B.vx;
  };
  EXPECT_NEAR(told(0.0), 0.3, 1e-9);
  EXPECT_GT(std::abs(told(0.5) - 0.3), 0.05);
}

TEST(SelfLocalisationTest, ARobotWithoutALaserCannotFindItsPlace) {
  imagination::ImaginationSetup setup = SetupOfRoom();
  setup.scene = hires::test_support::RoomScene();
  EXPECT_THAT(ConfigErrorOf([&] { SetupOf(TruthWith(ShippedParams()), setup, {}, base::Rng(1)); }),
              AllOf(HasSubstr("localisation: fitted"), HasSubstr("laser_link")));
}

// One that hands on what it measures
// ---------------------------------------------------------------

Truth TruthWithoutPlace() {
  Truth truth;
  truth.localisation = Localisation::kFilter;
  truth.self_localisation = std::make_shared<const SelfLocalisationParams>(ShippedParams());
  return WithoutPlace(truth, "");
}

TEST(WithoutPlaceTest, ItTakesTheFileWhereTheTruthSaysNothing) {
  const Truth truth = WithoutPlace({}, kConfig + "/self_localisation.yaml");
  EXPECT_EQ(truth.localisation, Localisation::kNothing);
  EXPECT_EQ(truth.self_localisation->casters.casters_B.size(), 4U);
  EXPECT_THAT(ConfigErrorOf([] { WithoutPlace({}, "none.yaml"); }), HasSubstr("none.yaml"));
}

TEST(WithoutPlaceTest, WheelsAndUnitMeasureTheWayWithTheirErrors) {
  SimRobotWorld world(SetupOfRoom(), Start(), 7, TruthWithoutPlace());
  const Pose2 X_MBstart = world.simulator().base().X_MB;
  const SensorReadings told = DriveInCircles(5.0, &world).told.back();
  const Pose2 driven = X_MBstart.Inverse() * world.simulator().base().X_MB;
  const double turned = geometry::WrapToPi(told.inertia->yaw - driven.yaw);
  EXPECT_GT(std::abs(turned), 1e-6);
  EXPECT_LT(std::abs(turned), 0.02);
  EXPECT_NEAR(told.inertia->yaw_rate, 0.4, 0.1);
  EXPECT_GT(Apart(told.odometry.X_OB, driven), 1e-4);
  EXPECT_LT(Apart(told.odometry.X_OB, driven), 0.1);
}

TEST(WithoutPlaceTest, TheSameSeedMeasuresTheSameBitForBitAndTwiceAtOneMoment) {
  SimRobotWorld a(SetupOfRoom(), Start(), 7, TruthWithoutPlace());
  SimRobotWorld b(SetupOfRoom(), Start(), 7, TruthWithoutPlace());
  SimRobotWorld c(SetupOfRoom(), Start(), 8, TruthWithoutPlace());
  const SensorReadings of_a = DriveInCircles(2.0, &a).told.back();
  const SensorReadings of_b = DriveInCircles(2.0, &b).told.back();
  EXPECT_EQ(of_a.inertia->yaw, of_b.inertia->yaw);
  EXPECT_EQ(of_a.odometry.X_OB.x, of_b.odometry.X_OB.x);
  EXPECT_NE(of_a.inertia->yaw, DriveInCircles(2.0, &c).told.back().inertia->yaw);
  EXPECT_EQ(a.Sense().inertia->yaw, of_a.inertia->yaw);
}

TEST(WithoutPlaceTest, OneThatIsCarriedMeasuresNothingOfIt) {
  SimRobotWorld world(SetupOfRoom(), Start(), 3, TruthWithoutPlace());
  const SensorReadings before = DriveInCircles(2.0, &world).told.back();
  ASSERT_EQ(world.Push({0.3, 0.0, 1.0}), "");
  world.Advance(sim_robot::kJointTick);
  const SensorReadings after = world.Sense();
  EXPECT_LT(Apart(after.odometry.X_OB, before.odometry.X_OB), 0.01);
  EXPECT_NEAR(after.inertia->yaw, before.inertia->yaw, 0.01);
}

TEST(WithoutPlaceTest, ItIsToldItsStartRoughlyUntilItMoves) {
  SimRobotWorld world(SetupOfRoom(), Start(), 3, TruthWithoutPlace());
  const auto told = world.ToldStart();
  ASSERT_TRUE(told);
  EXPECT_GT(Apart(told->X_MB, Start().robot.X_MB), 1e-4);
  EXPECT_LT(Apart(told->X_MB, Start().robot.X_MB), 0.15);
  EXPECT_DOUBLE_EQ(told->covariance(0, 0), 0.03 * 0.03);
  DriveInCircles(1.0, &world);
  EXPECT_FALSE(world.ToldStart());
  EXPECT_FALSE(SimRobotWorld(SetupOfRoom(), Start(), 3).ToldStart());
}

std::map<std::string, double> MeasuresOf(const std::string& experiment, int legs) {
  ExperimentOverrides overrides;
  overrides.runs = legs;
  const auto report =
      RunExperiment(ReadExperiment(HIRES_SOURCE_DIR "/lab/config/experiments/" + experiment, overrides), {});
  std::map<std::string, double> measures;
  for (const Measure& measure : report.value().findings.measures)
    measures[measure.name] = measure.value;
  return measures;
}

TEST(LostTest, ACarriedRobotNoticesIsFoundAndMostlyArrives) {
  const auto measures = MeasuresOf("lost_carried.yaml", 12);
  EXPECT_EQ(measures.at("astray"), 12.0);
  EXPECT_EQ(measures.at("noticed"), 12.0);
  EXPECT_EQ(measures.at("deceived"), 0.0);
  EXPECT_EQ(measures.at("contacts"), 0.0);
  EXPECT_GE(measures.at("found"), 8.0);
  EXPECT_GE(measures.at("reached"), 8.0);
}

TEST(LostTest, AMapOfAnotherDayMisleadsNobody) {
  const auto measures = MeasuresOf("lost_moved.yaml", 12);
  EXPECT_EQ(measures.at("astray"), 0.0);
  EXPECT_EQ(measures.at("reached"), 12.0);
  EXPECT_EQ(measures.at("contacts"), 0.0);
}

TEST(LostTest, WetPatchesLeadSomeAstrayAndDeceiveNobody) {
  const auto measures = MeasuresOf("lost_wet.yaml", 12);
  EXPECT_LE(measures.at("astray"), 8.0);  // measured: 5, of which 3 were noticed and found
  EXPECT_GE(measures.at("noticed"), 1.0);
  EXPECT_GE(measures.at("reached"), 8.0);
  EXPECT_EQ(measures.at("deceived"), 0.0);
  EXPECT_EQ(measures.at("contacts"), 0.0);
}

TEST(LostTest, BetweenEndsThatLookAlikeNothingIsNoticed) {
  const auto measures = MeasuresOf("lost_corridor.yaml", 40);
  EXPECT_GE(measures.at("astray"),
            20.0);  // each second leg; the others are at their goal, it seems
  EXPECT_EQ(measures.at("noticed"), 0.0);
  EXPECT_EQ(measures.at("deceived"), measures.at("astray"));
}

class SelfLocalisationFileTest : public ::testing::Test {
 protected:
  std::string ErrorAfter(const std::string& from, const std::string& to) {
    for (const char* name : {"localisation.yaml", "odometry_filter.yaml"})
      folder_.Write(name, base::ReadTextFile(kConfig + "/" + name));
    std::string text = base::ReadTextFile(kConfig + "/self_localisation.yaml");
    const std::size_t at = text.find(from);
    if (at == std::string::npos) return "the file has no " + from;
    const std::string path = folder_.Write("own.yaml", text.replace(at, from.size(), to));
    return ConfigErrorOf([&] { simulation::LoadSelfLocalisation(path); });
  }
  hires::test_support::TemporaryFolder folder_;
};

TEST_F(SelfLocalisationFileTest, WhatIsWrongIsSaidWithFileAndKey) {
  EXPECT_THAT(ErrorAfter("wear: 0.01", "wear: -1"),
              AllOf(HasSubstr("own.yaml"), HasSubstr("casters.wear")));
  EXPECT_THAT(ErrorAfter("y: 0.2246", "y: far"), HasSubstr("y"));
  EXPECT_THAT(ErrorAfter("walk: 0.0012", "wander: 0.0012"), HasSubstr("gyro"));
  EXPECT_THAT(ErrorAfter("filter: localisation.yaml", "filter: none.yaml"), HasSubstr("none.yaml"));
  EXPECT_THAT(ErrorAfter("angle_max: 2.2689", "angle_max: -3.0"), HasSubstr("angle_min"));
}

TEST_F(SelfLocalisationFileTest, ATruthThatFiltersNamesTheFile) {
  std::string text = base::ReadTextFile(kConfig + "/truths/same.yaml");
  const std::string from = "localisation: fitted";
  text.replace(text.find(from), from.size(), "localisation: filter");
  const std::string path = folder_.Write("truth.yaml", text);
  EXPECT_THAT(ConfigErrorOf([&] { sim_robot::ReadTruth(path); }), HasSubstr("self_localisation"));
  folder_.Write("truth.yaml", text + "self_localisation: " + kConfig + "/self_localisation.yaml\n");
  const Truth truth = sim_robot::ReadTruth(path);
  EXPECT_EQ(truth.localisation, Localisation::kFilter);
  EXPECT_EQ(truth.self_localisation->casters.casters_B.size(), 4U);
}

}  // namespace
}  // namespace hires::lab::self_localisation_test
