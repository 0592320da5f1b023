#include "hires/simulation/robot_simulator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "hires/physics/closed_forms.h"
#include "support/box_mesh.h"
#include "support/messages.h"
#include "support/scenes.h"

namespace hires::simulation::robot_simulator_test {
namespace {

using geometry::Pose2;
using test_support::AddModel;
using test_support::Block;
using test_support::ConfigErrorOf;
using test_support::kTrayTop;
using test_support::Mill;
using test_support::OnTray;
using test_support::Room;
using test_support::RoomScene;
using test_support::StandingAt;
using test_support::TrayRobot;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const Pose2 kMiddle{3.0, 2.0, 0.4};

world::WorldState With(std::vector<world::ObjectState> objects) { return {std::move(objects)}; }

robot::Command Drive(double vx, double vy = 0.0, double wz = 0.0) {
  robot::Command command;
  command.base_velocity = geometry::Twist2{vx, vy, wz};
  return command;
}

void StepFor(RobotSimulator* simulator, double duration) {
  for (long i = std::lround(duration / simulator->time_step()); i > 0; --i) simulator->Step();
}

/// Sends the same command every 50 ms for a while.
void DriveFor(RobotSimulator* simulator, const robot::Command& command, double duration) {
  for (long i = std::lround(duration / 0.05); i > 0; --i) {
    simulator->Send(command);
    StepFor(simulator, 0.05);
  }
}

// ---------------------------------------------------------------------------------- same bits

/// Everything that can be seen of a simulator, as numbers.
std::vector<double> Bits(RobotSimulator* simulator) {
  std::vector<double> bits{simulator->time()};
  const auto add_pose = [&](const geometry::Pose3& X) {
    for (int i = 0; i < 3; ++i) bits.push_back(X.translation[i]);
    for (int i = 0; i < 4; ++i) bits.push_back(X.rotation.coeffs()[i]);
  };
  add_pose(simulator->X_MB());
  for (const world::ObjectState& object : simulator->GetWorldState().objects) {
    add_pose(object.X_MO);
    for (int i = 0; i < 3; ++i) bits.push_back(object.V_MO.linear[i]);
    for (int i = 0; i < 3; ++i) bits.push_back(object.V_MO.angular[i]);
  }
  const robot::Observation seen = simulator->Observe(0.0);
  bits.insert(bits.end(), {seen.X_MB.x, seen.X_MB.y, seen.X_MB.yaw, seen.V_B.vx, seen.V_B.wz});
  for (const auto& outline : seen.obstacles_M) bits.push_back(outline.front().x());
  return bits;
}

/// A truth in which everything that draws chance does so.
Variation Lively() {
  Variation variation;
  variation.wheel_slip = 0.05;
  variation.floor_roughness = 0.0005;
  variation.localisation_noise = 0.01;
  variation.localisation_noise_yaw = 0.01;
  variation.ghost_rate = 2.0;
  variation.object_offset = {0.005, -0.004};
  return variation;
}

std::unique_ptr<RobotSimulator> LivelySimulator(const std::shared_ptr<const Scene>& scene) {
  return std::make_unique<RobotSimulator>(
      scene, Lively(),
      With({OnTray("a", "mill", kMiddle), OnTray("b", "tower", kMiddle, {0.0, 0.13})}),
      StandingAt(kMiddle), base::Rng(9));
}

/// Drives about; whatever falls rolls on the floor.
std::vector<std::vector<double>> Play(RobotSimulator* simulator, int cycles, std::uint64_t seed) {
  base::Rng rng(seed);
  std::vector<std::vector<double>> seen;
  for (int i = 0; i < cycles; ++i) {
    simulator->Send(Drive(rng.Uniform(-0.8, 0.8), rng.Uniform(-0.3, 0.3), rng.Uniform(-1.0, 1.0)));
    StepFor(simulator, 0.1);
    seen.push_back(Bits(simulator));
  }
  return seen;
}

TEST(RobotSimulatorTest, TheSameCallsGiveTheSameBits) {
  const auto scene = RoomScene();
  const auto first = LivelySimulator(scene), second = LivelySimulator(scene);
  EXPECT_EQ(Play(first.get(), 50, 1), Play(second.get(), 50, 1));
}

TEST(RobotSimulatorTest, RestoredItGoesOnWithTheSameBitsHereAndElsewhere) {
  const auto scene = RoomScene();
  const auto original = LivelySimulator(scene);
  Play(original.get(), 40, 1);
  const auto snapshot = original->Save();
  const auto expected = Play(original.get(), 40, 2);

  const auto other = LivelySimulator(scene);
  Play(other.get(), 7, 3);
  other->Restore(*snapshot);
  EXPECT_EQ(Play(other.get(), 40, 2), expected);

  original->Restore(*snapshot);
  EXPECT_EQ(Play(original.get(), 40, 2), expected);

  std::vector<std::vector<double>> in_thread;
  std::thread thread([&] {
    const auto far = LivelySimulator(scene);
    far->Restore(*snapshot);
    in_thread = Play(far.get(), 40, 2);
  });
  thread.join();
  EXPECT_EQ(in_thread, expected);
}

TEST(RobotSimulatorTest, TwoInTwoThreadsDoNotDisturbEachOther) {
  const auto scene = RoomScene();
  const auto expected = Play(LivelySimulator(scene).get(), 30, 1);
  std::vector<std::vector<double>> seen[2];
  std::vector<std::thread> threads;
  for (auto& mine : seen) {
    threads.emplace_back([&] { mine = Play(LivelySimulator(scene).get(), 30, 1); });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(seen[0], expected);
  EXPECT_EQ(seen[1], expected);
}

TEST(RobotSimulatorTest, AnotherSeedGivesOtherBits) {
  const auto scene = RoomScene();
  const auto start = With({OnTray("a", "mill", kMiddle)});
  RobotSimulator first(scene, Lively(), start, StandingAt(kMiddle), base::Rng(1));
  RobotSimulator second(scene, Lively(), start, StandingAt(kMiddle), base::Rng(2));
  EXPECT_NE(Play(&first, 5, 1), Play(&second, 5, 1));
}

// ------------------------------------------------------------------------------------ physics

TEST(RobotSimulatorTest, AMillOnAStandingRobotStays) {
  RobotSimulator simulator(RoomScene(), {}, With({OnTray("mill1", "mill", kMiddle)}),
                           StandingAt(kMiddle), base::Rng(1));
  const Eigen::Vector3d start = simulator.PoseOf(0).translation;
  for (int i = 0; i < 100; ++i) {
    StepFor(&simulator, 0.1);
    const geometry::Pose3 X_MO = simulator.PoseOf(0);
    ASSERT_LT((X_MO.translation - start).head<2>().norm(), 1e-4) << simulator.time() << " s";
    ASSERT_LT(geometry::TiltOf(X_MO.rotation), 1e-3) << simulator.time() << " s";
  }
  EXPECT_NEAR(simulator.PoseOf(0).translation.z(), test_support::kTrayTop, 2e-3);
}

/// Largest tilt [rad] of a model while the base accelerates at `acceleration` [m/s^2] for 2 s on an
/// endless floor, heading `yaw`. What falls backward comes to lean against the torso.
double TiltUnder(double acceleration, const Variation& variation = {}, double yaw = 0.0,
                 const std::string& model = "mill") {
  world::World plain = Room();
  plain.statics.clear();
  robot::Robot robot = TrayRobot();
  robot.profile.base_controller.limits = {100.0, 2.0, acceleration, 2.0};
  const Pose2 X_MB{0.0, 0.0, yaw};
  RobotSimulator simulator(simulation::MakeScene(plain, robot), variation,
                           With({OnTray("mill1", model, X_MB)}), StandingAt(X_MB), base::Rng(1));
  StepFor(&simulator, 0.2);
  double tilt = 0.0;
  for (int i = 0; i < 200; ++i) {
    simulator.Send(Drive(90.0));
    StepFor(&simulator, 0.01);
    tilt = std::max(tilt, geometry::TiltOf(simulator.PoseOf(0).rotation));
  }
  return tilt;
}

TEST(RobotSimulatorTest, TipsAboveItsTippingAccelerationAndStandsBelow) {
  const double tipping = physics::TippingAcceleration({}, 9.81);
  for (const double yaw : {0.0, 0.6, 1.9, -2.5}) {
    EXPECT_LT(TiltUnder(0.95 * tipping, {}, yaw), 0.01) << "yaw " << yaw;
    EXPECT_GT(TiltUnder(1.05 * tipping, {}, yaw), 0.8) << "yaw " << yaw;
  }
}

TEST(RobotSimulatorTest, VariationMovesTheTippingPoint) {
  const double tipping = physics::TippingAcceleration({}, 9.81);
  Variation narrow;
  narrow.radius_factor = 0.8;
  EXPECT_LT(TiltUnder(0.95 * 0.8 * tipping, narrow), 0.01);
  EXPECT_GT(TiltUnder(1.05 * 0.8 * tipping, narrow), 0.8);
  Variation top_heavy;
  top_heavy.com_height_factor = 1.25;
  EXPECT_LT(TiltUnder(0.95 / 1.25 * tipping, top_heavy), 0.01);
  EXPECT_GT(TiltUnder(1.05 / 1.25 * tipping, top_heavy), 0.8);
  Variation heavy;
  heavy.mass_factor = 3.0;
  EXPECT_LT(TiltUnder(0.95 * tipping, heavy), 0.01);
  EXPECT_GT(TiltUnder(1.05 * tipping, heavy), 0.8);
}

TEST(RobotSimulatorTest, OnASlipperyTrayItSlidesInsteadOfTipping) {
  Variation slippery;  // 0.8 * 0.25 = 0.2: slides above 1.96 m/s^2, tips at 2.65
  slippery.friction_factor = 0.25;
  world::World plain = Room();
  plain.statics.clear();
  robot::Robot robot = TrayRobot();
  robot.profile.base_controller.limits = {100.0, 2.0, 2.3, 2.0};
  RobotSimulator simulator(simulation::MakeScene(plain, robot), slippery,
                           With({OnTray("mill1", "mill", {}, {0.05, 0.0})}), StandingAt({}),
                           base::Rng(1));
  StepFor(&simulator, 0.2);
  DriveFor(&simulator, Drive(90.0), 0.5);
  const double slid = test_support::kTrayX + 0.05 -
                      (simulator.X_MB().Inverse() * simulator.PoseOf(0)).translation.x();
  EXPECT_NEAR(slid, 0.5 * (2.3 - 0.2 * 9.81) * 0.5 * 0.5, 0.005);
}

TEST(RobotSimulatorTest, StartOffsetMovesTheRobotAndItsLoad) {
  Variation variation;
  variation.start_offset = {0.1, -0.05, 0.2};
  RobotSimulator simulator(RoomScene(), variation, With({OnTray("mill1", "mill", kMiddle)}),
                           StandingAt(kMiddle), base::Rng(1));
  const Pose2 X_MB = kMiddle * variation.start_offset;
  EXPECT_NEAR(simulator.base().X_MB.x, X_MB.x, 1e-12);
  EXPECT_NEAR(simulator.base().X_MB.yaw, X_MB.yaw, 1e-12);
  const Eigen::Vector2d p_MO = X_MB * Eigen::Vector2d(test_support::kTrayX, 0.0);
  EXPECT_NEAR((simulator.PoseOf(0).translation.head<2>() - p_MO).norm(), 0.0, 1e-9);
}

TEST(RobotSimulatorTest, ObjectOffsetMovesWhatStandsOnTheTrayAlone) {
  Variation variation;
  variation.object_offset = {0.02, -0.01};
  world::ObjectState beside = OnTray("beside", "mill", {1.0, 1.0, 0.0});
  beside.X_MO.translation.z() = 0.0002;
  RobotSimulator simulator(RoomScene(), variation,
                           With({OnTray("mill1", "mill", {3.0, 2.0, 0.0}), beside}),
                           StandingAt({3.0, 2.0, 0.0}), base::Rng(1));
  EXPECT_NEAR(simulator.PoseOf(0).translation.x(), 3.0 + test_support::kTrayX + 0.02, 1e-9);
  EXPECT_NEAR(simulator.PoseOf(0).translation.y(), 2.0 - 0.01, 1e-9);
  EXPECT_NEAR(simulator.PoseOf(1).translation.x(), beside.X_MO.translation.x(), 1e-9);
}

// ------------------------------------------------------------------------- what is carried

TEST(RobotSimulatorTest, CarriedIsWhatStandsOnTheRobot) {
  world::ObjectState on_floor = OnTray("on_floor", "mill", {1.5, 1.0, 0.0});
  on_floor.X_MO.translation.z() = 0.0002;
  world::ObjectState in_the_air = OnTray("in_the_air", "mill", kMiddle, {0.1, -0.19});
  in_the_air.X_MO.translation.z() += 0.2;
  world::ObjectState held = OnTray("held", "mill", kMiddle, {0.0, -0.1});
  held.attached_to = "tray";
  RobotSimulator simulator(RoomScene(), {},
                           With({on_floor, OnTray("first", "mill", kMiddle), in_the_air, held,
                                 OnTray("second", "tower", kMiddle, {0.0, 0.15})}),
                           StandingAt(kMiddle), base::Rng(1));
  EXPECT_THAT(simulator.carried(), ElementsAre(1, 4));
}

TEST(RobotSimulatorTest, TouchedIsWhatStandsOrIsHeldAndNotWhatFalls) {
  world::ObjectState falling = OnTray("falling", "mill", {1.5, 1.0, 0.0});
  falling.X_MO.translation.z() = 1.0;
  world::ObjectState held = OnTray("held", "mill", kMiddle, {0.0, -0.15});
  held.X_MO.translation.z() += 0.3;
  held.attached_to = "tray";
  RobotSimulator simulator(RoomScene(), {},
                           With({falling, OnTray("standing", "mill", kMiddle), held}),
                           StandingAt(kMiddle), base::Rng(1));
  StepFor(&simulator, 0.2);  // 0.2 m down
  EXPECT_FALSE(simulator.IsTouched(0));
  EXPECT_TRUE(simulator.IsTouched(1));
  EXPECT_TRUE(simulator.IsTouched(2));
  StepFor(&simulator, 0.8);
  EXPECT_TRUE(simulator.IsTouched(0));  // it lies on the floor
}

TEST(RobotSimulatorTest, RefusesJointsOfAnotherRobot) {
  robot::RobotState state = StandingAt(kMiddle);
  state.joints["l_shoulder_pan_joynt"] = 0.1;
  try {
    RobotSimulator(RoomScene(), {}, {}, state, base::Rng(1));
    FAIL() << "accepted";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("joint 'l_shoulder_pan_joynt' is unknown"));
  }
}

TEST(RobotSimulatorTest, RefusesObjectsInEachOtherAndOneNamedTwice) {
  const auto refusal = [](const world::WorldState& state) -> std::string {
    try {
      RobotSimulator(RoomScene(), {}, state, StandingAt(kMiddle), base::Rng(1));
    } catch (const base::ConfigError& error) {
      return error.what();
    }
    return "";
  };
  const world::ObjectState first = OnTray("first", "mill", kMiddle);
  EXPECT_THAT(refusal(With({first, OnTray("second", "mill", kMiddle, {0.0, 0.05})})),
              ::testing::HasSubstr("'second' starts inside 'first'"));
  EXPECT_THAT(refusal(With({first, OnTray("FIRST", "mill", kMiddle, {0.0, 0.15})})),
              ::testing::HasSubstr("'FIRST' is there twice"));
  EXPECT_EQ(refusal(With({first, OnTray("second", "mill", kMiddle, {0.0, 0.15})})), "");
}

TEST(RobotSimulatorTest, AttachedObjectsRideAlongRigidly) {
  robot::Robot robot = TrayRobot();
  robot.profile.base_controller.sway_compliance = 0.005;
  world::ObjectState held = OnTray("held", "tower", {1.5, 2.0, 0.0});
  held.attached_to = "tray";
  RobotSimulator simulator(simulation::MakeScene(Room(), robot), {}, With({held}),
                           StandingAt({1.5, 2.0, 0.0}), base::Rng(1));
  const geometry::Pose3 X_BO = simulator.X_MB().Inverse() * simulator.PoseOf(0);
  EXPECT_THAT(simulator.carried(), IsEmpty());
  for (int i = 0; i < 20; ++i) {
    DriveFor(&simulator, Drive(0.8, 0.0, 0.4), 0.05);
    const geometry::Pose3 X_BO_now = simulator.X_MB().Inverse() * simulator.PoseOf(0);
    EXPECT_LT((X_BO_now.translation - X_BO.translation).norm(), 1e-12);
    EXPECT_LT(X_BO_now.rotation.angularDistance(X_BO.rotation), 1e-9);
  }
  EXPECT_GT(simulator.base().X_MB.x, 1.9);
  EXPECT_THROW(simulator.PutBack(0), std::logic_error);
}

TEST(RobotSimulatorTest, AttachedObjectPushesAnObjectInItsPath) {
  // It reaches over the front of base and tray, which reach the other tower later.
  world::ObjectState held = OnTray("held", "tower", {1.5, 2.0, 0.0}, {0.12, 0.1});
  held.attached_to = "tray";
  world::ObjectState on_floor = OnTray("on_floor", "tower", {1.5, 2.0, 0.0}, {0.4, 0.1});
  on_floor.X_MO.translation.z() = 0.0002;
  RobotSimulator simulator(RoomScene(), {}, With({held, on_floor}), StandingAt({1.5, 2.0, 0.0}),
                           base::Rng(1));
  DriveFor(&simulator, Drive(0.8), 0.5);
  EXPECT_LT(simulator.base().X_MB.x + 0.3, 2.1 - 0.037);
  EXPECT_GT(geometry::TiltOf(simulator.PoseOf(1).rotation), 0.05);
}

TEST(RobotSimulatorTest, PutBackStandsItUprightAndMovingWithTheRobot) {
  RobotSimulator simulator(RoomScene(), {}, With({OnTray("tower1", "tower", {1.5, 2.0, 0.0})}),
                           StandingAt({1.5, 2.0, 0.0}), base::Rng(1));
  const geometry::Pose3 X_BO = simulator.X_MB().Inverse() * simulator.PoseOf(0);
  StepFor(&simulator, 0.2);
  DriveFor(&simulator, Drive(0.0, 0.9), 0.6);  // sideways: ahead stands the torso
  DriveFor(&simulator, Drive(0.0), 1.0);
  ASSERT_GT(geometry::TiltOf(simulator.PoseOf(0).rotation), 0.5) << "it ought to have fallen";
  DriveFor(&simulator, Drive(0.4, 0.0, 0.5), 0.8);
  simulator.PutBack(0);
  const geometry::Pose3 X_BO_now = simulator.X_MB().Inverse() * simulator.PoseOf(0);
  EXPECT_LT((X_BO_now.translation - X_BO.translation).norm(), 1e-12);
  EXPECT_LT(geometry::TiltOf(simulator.PoseOf(0).rotation), 1e-9);
  DriveFor(&simulator, Drive(0.4, 0.0, 0.5), 1.0);
  EXPECT_LT(geometry::TiltOf(simulator.PoseOf(0).rotation), 0.02) << "it fell when put back";
}

// --------------------------------------------------------------------------- contact, causes

TEST(RobotSimulatorTest, DrivingIntoTheWallIsAContact) {
  RobotSimulator simulator(RoomScene(), {}, {}, StandingAt({5.0, 2.0, 0.0}), base::Rng(1));
  DriveFor(&simulator, Drive(0.5), 1.0);
  EXPECT_FALSE(simulator.contact());
  DriveFor(&simulator, Drive(0.5), 1.0);
  ASSERT_TRUE(simulator.contact());
  EXPECT_EQ(simulator.contact()->obstacle, "east_wall");
  EXPECT_EQ(simulator.contact()->robot_part, "tray/plate");
}

TEST(RobotSimulatorTest, NotesWhatMayDisturbTheLoad) {
  robot::Robot robot = TrayRobot();
  robot.profile.base_controller.command_timeout = 0.2;
  RobotSimulator simulator(simulation::MakeScene(Room(), robot), {}, {},
                           StandingAt({2.0, 2.0, 0.0}), base::Rng(1));
  StepFor(&simulator, 0.5);
  EXPECT_LT(simulator.disturbances().accelerating, 0.0);
  DriveFor(&simulator, Drive(0.5), 1.0);  // 0.25 s of ramp
  EXPECT_NEAR(simulator.disturbances().accelerating, 0.75, 0.002);
  EXPECT_LT(simulator.disturbances().braking, 0.0);
  DriveFor(&simulator, Drive(0.0), 1.0);
  EXPECT_NEAR(simulator.disturbances().braking, 1.75, 0.002);
  DriveFor(&simulator, Drive(0.0, 0.0, 1.0), 1.0);  // 0.5 s of ramp
  EXPECT_NEAR(simulator.disturbances().turning, 3.0, 0.002);
  EXPECT_LT(simulator.disturbances().late_command, 0.0);
  StepFor(&simulator, 0.5);
  EXPECT_GT(simulator.disturbances().late_command, 3.5);
}

// ------------------------------------------------------------------------------------ senses

TEST(RobotSimulatorTest, BelievedPosesHaveTheirBiasAndNoise) {
  Variation variation;
  variation.localisation_bias = {0.05, -0.02, 0.01};
  variation.localisation_noise = 0.004;
  variation.localisation_noise_yaw = 0.003;
  RobotSimulator simulator(RoomScene(), variation, {}, StandingAt({3.0, 2.0, 0.0}), base::Rng(5));
  const int count = 10000;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), squares = Eigen::Vector3d::Zero();
  for (int i = 0; i < count; ++i) {
    const Pose2 X_MB = simulator.Observe(0.0).X_MB;
    const Eigen::Vector3d off(X_MB.x - 3.0, X_MB.y - 2.0, X_MB.yaw);
    sum += off;
    squares += off.cwiseProduct(off);
  }
  const Eigen::Vector3d mean = sum / count;
  const Eigen::Vector3d sd = (squares / count - mean.cwiseProduct(mean)).cwiseSqrt();
  EXPECT_NEAR(mean.x(), 0.05, 4.0 * 0.004 / std::sqrt(count));
  EXPECT_NEAR(mean.y(), -0.02, 4.0 * 0.004 / std::sqrt(count));
  EXPECT_NEAR(mean.z(), 0.01, 4.0 * 0.003 / std::sqrt(count));
  EXPECT_NEAR(sd.x(), 0.004, 0.03 * 0.004);
  EXPECT_NEAR(sd.y(), 0.004, 0.03 * 0.004);
  EXPECT_NEAR(sd.z(), 0.003, 0.03 * 0.003);
}

TEST(RobotSimulatorTest, WithoutVariationItSeesTheTruth) {
  RobotSimulator simulator(RoomScene(), {}, {}, StandingAt({3.0, 2.0, 0.5}), base::Rng(5));
  DriveFor(&simulator, Drive(0.3, 0.1, 0.2), 1.0);
  const robot::Observation seen = simulator.Observe(0.4);
  EXPECT_NEAR(seen.time, 0.6, 1e-12);
  EXPECT_EQ(seen.X_MB.x, simulator.base().X_MB.x);
  EXPECT_NEAR(seen.X_MB.yaw, simulator.base().X_MB.yaw, 1e-12);
  EXPECT_EQ(seen.V_B.vx, simulator.base().V_B.vx);
  EXPECT_THAT(seen.obstacles_M, IsEmpty());
}

TEST(RobotSimulatorTest, AsWheelsSlipOdometryCountsAllWaysTooLongOrTooShort) {
  const int count = 60;
  double squares = 0.0;
  for (int seed = 0; seed < count; ++seed) {
    Variation variation;
    variation.wheel_slip = 0.03;
    RobotSimulator simulator(RoomScene(), variation, {}, StandingAt({2.0, 2.0, 0.0}),
                             base::Rng(seed));
    const auto odometry = [&] { return simulator.Observe(0.0).X_OB; };
    const Pose2 X_OBstart = odometry(), X_MBstart = simulator.base().X_MB;
    DriveFor(&simulator, Drive(0.4, 0.1, 0.0), 1.0);
    const double half =
        (X_OBstart.Inverse() * odometry()).x / (X_MBstart.Inverse() * simulator.base().X_MB).x;
    DriveFor(&simulator, Drive(0.4, 0.1, 0.0), 1.0);
    const double whole =
        (X_OBstart.Inverse() * odometry()).x / (X_MBstart.Inverse() * simulator.base().X_MB).x;
    EXPECT_NEAR(half, whole, 1e-3) << "the same all the way";
    EXPECT_NEAR(simulator.Observe(0.0).V_B.vx / simulator.base().V_B.vx, whole, 1e-3);
    squares += (whole - 1.0) * (whole - 1.0) / count;
  }
  EXPECT_NEAR(std::sqrt(squares), 0.03, 0.03 * 4.0 / std::sqrt(2.0 * count));
}

TEST(RobotSimulatorTest, GhostsComeAtTheirRateBeforeTheRobotAndGo) {
  Variation variation;
  variation.ghost_rate = 0.5;
  RobotSimulator simulator(RoomScene(), variation, {}, StandingAt(kMiddle), base::Rng(5));
  int appeared = 0;
  double seen_for = 0.0;  // [s] summed over all ghosts
  Eigen::Vector2d last_corner(0.0, 0.0);
  for (int i = 0; i < 2000; ++i) {
    StepFor(&simulator, 0.1);
    const auto ghosts = simulator.Observe(0.0).obstacles_M;
    seen_for += 0.1 * static_cast<double>(ghosts.size());
    if (ghosts.empty() || ghosts.back().front() == last_corner) continue;
    last_corner = ghosts.back().front();
    ++appeared;
    const Eigen::Vector2d p_BG =
        kMiddle.Inverse() * Eigen::Vector2d(0.5 * (ghosts.back()[0] + ghosts.back()[2]));
    EXPECT_GT(p_BG.norm(), 0.79);
    EXPECT_LT(p_BG.norm(), 2.51);
    EXPECT_GT(p_BG.x(), 0.0);
  }
  EXPECT_NEAR(appeared, 100, 40);  // 200 s: four standard deviations
  EXPECT_NEAR(seen_for / appeared, 4.6, 0.25);
}

// -------------------------------------------------------------------------------- bad starts

std::string WhyRefused(const world::WorldState& world_state, const Pose2& X_MB,
                       world::World world = Room()) {
  const auto scene = simulation::MakeScene(std::move(world), TrayRobot());
  return ConfigErrorOf(
      [&] { RobotSimulator(scene, {}, world_state, StandingAt(X_MB), base::Rng(1)); });
}

TEST(RobotSimulatorTest, RefusesARobotThatIsNowhere) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(WhyRefused({}, {nan, 0.0, 0.0}),
              AllOf(HasSubstr("the robot"), HasSubstr("not finite")));
  EXPECT_THAT(WhyRefused({}, {3.0, 2.0, nan}), HasSubstr("not finite"));
  EXPECT_THAT(WhyRefused({}, {std::numeric_limits<double>::infinity(), 0.0, 0.0}),
              HasSubstr("not finite"));
  EXPECT_THAT(WhyRefused({}, {2e6, 0.0, 0.0}),
              AllOf(HasSubstr("the robot"), HasSubstr("2000000 m"), HasSubstr("1000 m")));
}

TEST(RobotSimulatorTest, RefusesARobotInAWall) {
  EXPECT_THAT(WhyRefused({}, {5.9, 2.0, 0.0}),
              AllOf(HasSubstr("robot starts in collision"), HasSubstr("'east_wall'"),
                    HasSubstr("x 5.900 m"), HasSubstr("move the start")));
}

TEST(RobotSimulatorTest, RefusesObjectsWithoutAPlace) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  world::ObjectState object = OnTray("mill1", "mill", kMiddle);
  object.X_MO.translation.y() = nan;
  EXPECT_THAT(WhyRefused(With({object}), kMiddle),
              AllOf(HasSubstr("object 'mill1'"), HasSubstr("not finite")));
  object = OnTray("mill1", "mill", kMiddle);
  object.X_MO.translation.x() = -5000.0;
  EXPECT_THAT(WhyRefused(With({object}), kMiddle),
              AllOf(HasSubstr("object 'mill1'"), HasSubstr("5000 m")));
}

TEST(RobotSimulatorTest, RefusesObjectsWithoutARotationOrVelocity) {
  world::ObjectState object = OnTray("mill1", "mill", kMiddle);
  object.X_MO.rotation.coeffs().setZero();
  EXPECT_THAT(WhyRefused(With({object}), kMiddle),
              AllOf(HasSubstr("object 'mill1'"), HasSubstr("unit length")));
  object = OnTray("mill1", "mill", kMiddle);
  object.V_MO.linear.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(WhyRefused(With({object}), kMiddle),
              AllOf(HasSubstr("object 'mill1'"), HasSubstr("velocity"), HasSubstr("not finite")));
}

TEST(RobotSimulatorTest, RefusesObjectsOfUnknownModels) {
  EXPECT_THAT(WhyRefused(With({OnTray("mill1", "mil", kMiddle)}), kMiddle),
              AllOf(HasSubstr("object 'mill1'"), HasSubstr("model 'mil' is unknown"),
                    HasSubstr("did you mean 'mill'")));
}

TEST(RobotSimulatorTest, RefusesObjectsHeldByUnknownLinks) {
  world::ObjectState held = OnTray("mill1", "mill", kMiddle);
  held.attached_to = "tary";
  EXPECT_THAT(WhyRefused(With({held}), kMiddle),
              AllOf(HasSubstr("object 'mill1'"), HasSubstr("link 'tary' is unknown"),
                    HasSubstr("did you mean 'tray'")));
}

/// Whether a base with these numbers can be simulated at 1 kHz, and if so, comes near its velocity.
std::string WhyTooStiff(const robot::BaseControllerParams& base, const Variation& variation = {}) {
  robot::Robot robot = TrayRobot();
  robot.profile.base_controller = base;
  return ConfigErrorOf([&] {
    RobotSimulator simulator(simulation::MakeScene(Room(), robot), variation, {},
                             StandingAt({2.0, 2.0, 0.0}), base::Rng(1));
    DriveFor(&simulator, Drive(0.5), 2.0);
    EXPECT_GT(simulator.base().V_B.vx, 0.3);
    EXPECT_LT(simulator.base().V_B.vx, 0.51);
    EXPECT_LT(std::abs(simulator.base().pitch), 0.1);
  });
}

TEST(RobotSimulatorTest, RefusesABaseThatIsTooStiffForItsTimeStep) {
  robot::BaseControllerParams base = TrayRobot().profile.base_controller;
  base.loop_frequency = 3000.0;
  EXPECT_THAT(WhyTooStiff(base),
              AllOf(HasSubstr("loop_frequency 3000 rad/s"), HasSubstr("time step of 0.001 s")));
  base.loop_frequency = 20.0;
  base.loop_damping = 10.0;
  EXPECT_THAT(WhyTooStiff(base), HasSubstr("no ConfigError"));
  Variation sluggish;
  sluggish.loop_damping_factor = 10.0;
  EXPECT_THAT(WhyTooStiff(base, sluggish), HasSubstr("loop_damping 100"));
  base.loop_damping = 1.0;
  base.sway_compliance = 0.005;
  base.sway_frequency = 200.0;
  base.sway_damping = 2.0;
  EXPECT_THAT(WhyTooStiff(base), HasSubstr("no ConfigError"));
  base.sway_damping = 10.0;
  EXPECT_THAT(WhyTooStiff(base), HasSubstr("sway_damping 10"));
}

TEST(RobotSimulatorTest, RefusesObjectsInsideOtherThings) {
  world::ObjectState in_wall = OnTray("mill1", "mill", kMiddle);
  in_wall.X_MO.translation = {6.03, 2.0, 0.0};
  EXPECT_THAT(WhyRefused(With({in_wall}), kMiddle),
              AllOf(HasSubstr("object 'mill1' starts inside 'east_wall'"), HasSubstr("free")));
  world::ObjectState in_robot = OnTray("mill1", "mill", kMiddle);
  in_robot.X_MO.translation.z() -= 0.1;
  EXPECT_THAT(WhyRefused(With({in_robot}), kMiddle),
              AllOf(HasSubstr("object 'mill1' starts inside the robot, 0."),
                    HasSubstr("m deep in '"), HasSubstr("give the height of what it stands on")));
}

/// A mill, or a box as large.
world::World RoomWith(bool is_box) {
  world::World room = Room();
  room.statics.push_back(Block("table", {0.8, 0.8, 0.02}, {1.0, 1.0, 0.74}));
  world::ObjectModel thing = Mill("thing", 0.1, 0.05);
  if (is_box) {
    const geometry::Box box{{0.1, 0.1, 0.1}};
    thing.collisions.front().shape = box;
    thing.mass_properties.I_BBcm = geometry::SolidInertia(box, thing.mass_properties.mass);
  }
  AddModel(&room, thing);
  return room;
}

/// What starts `depth` [m] deep in what it stands on: the floor, a table, the tray, one another.
std::vector<world::ObjectState> Sunk(double depth) {
  std::vector<world::ObjectState> objects(5, OnTray("on_tray", "thing", kMiddle));
  objects[0].X_MO.translation.z() = kTrayTop - depth;
  for (int i = 1; i < 5; ++i) {
    objects[i].name = "thing" + std::to_string(i);
    objects[i].X_MO.rotation.setIdentity();
  }
  objects[1].X_MO.translation = {2.0, 3.0, -depth};
  for (int i = 2; i < 5; ++i)
    objects[i].X_MO.translation = {1.0, 1.0, 0.75 - depth + (i - 2) * (0.1 - depth)};
  return objects;
}

TEST(RobotSimulatorTest, WhatStartsALittleDeepInItsSupportIsTakenOutAndStays) {
  for (const bool is_box : {false, true}) {
    const auto scene = simulation::MakeScene(RoomWith(is_box), TrayRobot());
    for (const double depth : {0.0, 0.0005, 0.001, 0.0015, 0.0019, 0.0021, 0.003, 0.004, 0.0044,
                               0.0045, 0.0046, 0.0048, 0.0049, 0.00499}) {
      const std::vector<world::ObjectState> objects = Sunk(depth);
      RobotSimulator simulator(scene, {}, With(objects), StandingAt(kMiddle), base::Rng(1));
      const geometry::Pose3 X_MOstart = simulator.PoseOf(0);
      EXPECT_NEAR(X_MOstart.translation.z(), kTrayTop, depth < 0.002 ? depth + 1e-9 : 1e-6);
      StepFor(&simulator, 0.5);
      EXPECT_FALSE(simulator.broken_object()) << depth << " m deep, box: " << is_box;
      for (int i = 0; i < 5; ++i) {
        const geometry::Pose3 X_MO = simulator.PoseOf(i);
        EXPECT_LT((X_MO.translation - objects[i].X_MO.translation).norm(), 0.02)
            << i << ": " << depth << " m deep, box: " << is_box;
        EXPECT_LT(geometry::TiltOf(X_MO.rotation), 0.02);
      }
      simulator.PutBack(0);
      EXPECT_LT((simulator.PoseOf(0).translation - X_MOstart.translation).norm(), 1e-4);
    }
  }
}

TEST(RobotSimulatorTest, ThingsStandInABasketThatIsOneMesh) {
  robot::Robot robot = TrayRobot();
  robot.model.links[1].collisions = {
      test_support::Shape("basket", test_support::Basket(), {0.0, 0.0, -0.01})};
  const auto scene = MakeScene(test_support::Room(), robot);
  RobotSimulator simulator(scene, {}, With({OnTray("mill1", "mill", kMiddle)}), StandingAt(kMiddle),
                           base::Rng(1));
  EXPECT_THAT(simulator.carried(), ::testing::ElementsAre(0));
  StepFor(&simulator, 0.5);
  EXPECT_TRUE(simulator.StandsOnRobot(0));
  EXPECT_NEAR(simulator.PoseOf(0).translation.z(), kTrayTop, 2e-3);
  try {
    RobotSimulator(scene, {}, With({OnTray("mill1", "mill", kMiddle, {0.19, 0.0})}),
                   StandingAt(kMiddle), base::Rng(1));
    FAIL() << "stands in the wall";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("starts inside the robot"));
  }
}

TEST(RobotSimulatorTest, AllThatStandsInSomethingIsRefusedAtOnce) {
  world::ObjectState in_wall = OnTray("mill1", "mill", kMiddle);
  in_wall.X_MO.translation = {6.03, 2.0, 0.0};
  world::ObjectState in_robot = OnTray("mill2", "mill", kMiddle);
  in_robot.X_MO.translation.z() -= 0.1;
  EXPECT_THAT(WhyRefused(With({in_wall, in_robot}), kMiddle),
              AllOf(HasSubstr("2 things are wrong"), HasSubstr("'mill1' starts inside 'east_wall'"),
                    HasSubstr("'mill2' starts inside the robot")));
}

TEST(RobotSimulatorTest, NamesTheOneOfSeveralObjectsThatIsInsideTheRobot) {
  world::ObjectState sunk = OnTray("mill2", "mill", kMiddle);
  sunk.X_MO.translation.z() -= 0.1;
  world::ObjectState away = OnTray("mill1", "mill", kMiddle);
  away.X_MO.translation = {1.0, 1.0, 0.0};
  EXPECT_THAT(WhyRefused(With({away, sunk}), kMiddle), HasSubstr("object 'mill2' starts inside"));
  EXPECT_THAT(WhyRefused(With({sunk, away}), kMiddle), HasSubstr("object 'mill2' starts inside"));
}

TEST(StartInsideTest, AModelWithItsOriginInItsMiddleIsToldAsTheCause) {
  world::World world = Room();
  auto model = std::make_shared<world::ObjectModel>(*world.models.at("mill"));
  for (geometry::Collision& shape : model->collisions) shape.X_BS.translation.z() -= 0.05;
  world.models["mill"] = model;
  const auto scene = simulation::MakeScene(world, TrayRobot());
  try {
    RobotSimulator(scene, {}, With({OnTray("mill1", "mill", kMiddle)}), StandingAt(kMiddle),
                   base::Rng(1));
    FAIL() << "no error";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("below its origin"), HasSubstr("'mill'")));
  }
}

TEST(RobotSimulatorTest, AcceptsAnObjectThatStandsOnATable) {
  world::World room = Room();
  room.statics.push_back(Block("table", {0.8, 0.8, 0.7}, {1.0, 1.0, 0.35}));
  world::ObjectState on_table = OnTray("mill1", "mill", kMiddle);
  on_table.X_MO.translation = {1.0, 1.0, 0.7};
  const auto scene = simulation::MakeScene(room, TrayRobot());
  RobotSimulator simulator(scene, {}, With({on_table}), StandingAt(kMiddle), base::Rng(1));
  StepFor(&simulator, 0.5);
  EXPECT_NEAR(simulator.PoseOf(0).translation.z(), 0.7, 2e-3);
  EXPECT_THAT(simulator.carried(), IsEmpty());
}

}  // namespace
}  // namespace hires::simulation::robot_simulator_test
