#include <gmock/gmock.h>

#include <thread>

#include "arm_scene.h"
#include "support/messages.h"

namespace hires::simulation::planar_simulator_test {
namespace {

using namespace test_arm;  // NOLINT: the scene's words
using test_support::ConfigErrorOf;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// ---------------------------------------------------------------------------------- same bits

std::vector<double> Bits(RobotSimulator* simulator) {
  std::vector<double> bits{simulator->time()};
  for (const world::ObjectState& object : simulator->GetWorldState().objects) {
    bits.insert(bits.end(), object.X_MO.translation.data(), object.X_MO.translation.data() + 3);
    bits.insert(bits.end(), object.X_MO.rotation.coeffs().data(),
                object.X_MO.rotation.coeffs().data() + 4);
    bits.insert(bits.end(), object.V_MO.linear.data(), object.V_MO.linear.data() + 3);
    bits.push_back(object.attached_to.empty() ? 0.0 : 1.0);
  }
  const robot::Observation seen = simulator->Observe(0.0);
  for (const auto& [name, position] : seen.joints) bits.push_back(position);
  for (const auto& [name, velocity] : seen.joint_velocities) bits.push_back(velocity);
  for (const robot::SeenObject& object : seen.objects) {
    bits.insert(bits.end(), object.X_MO.translation.data(), object.X_MO.translation.data() + 3);
    bits.push_back(object.time);
  }
  return bits;
}

Variation Lively() {
  Variation variation;
  variation.localisation_noise = 0.005;
  variation.detection_noise = 0.004;
  variation.detection_noise_yaw = 0.02;
  variation.encoder_noise = 0.001;
  variation.mass_factor = 1.1;
  return variation;
}

std::unique_ptr<RobotSimulator> LivelySimulator() {
  return Simulator({MugAt(), MugAt({0.0, 0.25}, "mug2")}, Lively());
}

/// Closes on the mug, lifts it, swings it against the other one and lets it fall.
std::vector<std::vector<double>> Play(RobotSimulator* simulator, int from, int to) {
  std::vector<std::vector<double>> seen;
  for (int i = from; i < to; ++i) {
    if (i == 2) simulator->Send(Gripper(0.0));
    if (i == 10) simulator->Send(TorsoTo(kTorso + 0.05));
    if (i == 20) simulator->Send(JointTo("rightarm1", "r_shoulder_pan_joint", 0.5, 0.7));
    if (i == 21) simulator->Send(JointTo("head", "head_tilt_joint", 0.6, 0.3));
    if (i == 35) simulator->Send(Gripper(0.09));
    StepFor(simulator, 0.1);
    seen.push_back(Bits(simulator));
  }
  return seen;
}

TEST(PlanarSimulatorTest, TheSameCallsGiveTheSameBits) {
  EXPECT_EQ(Play(LivelySimulator().get(), 0, 45), Play(LivelySimulator().get(), 0, 45));
}

TEST(PlanarSimulatorTest, RestoredItGoesOnWithTheSameBitsHereAndElsewhere) {
  // In the middle of closing (4), of lifting (12), of the swing (23), of the fall (37).
  for (const int moment : {4, 12, 23, 37}) {
    const auto original = LivelySimulator();
    Play(original.get(), 0, moment);
    const auto snapshot = original->Save();
    const auto expected = Play(original.get(), moment, 45);
    original->Restore(*snapshot);
    EXPECT_EQ(Play(original.get(), moment, 45), expected) << moment;
    const auto other = LivelySimulator();
    Play(other.get(), 0, 30);
    other->Restore(*snapshot);
    EXPECT_EQ(Play(other.get(), moment, 45), expected) << moment;
  }
}

TEST(PlanarSimulatorTest, TwoInTwoThreadsDoNotDisturbEachOther) {
  const auto expected = Play(LivelySimulator().get(), 0, 45);
  std::vector<std::vector<double>> seen[2];
  std::vector<std::thread> threads;
  for (auto& mine : seen) {
    threads.emplace_back([&] { mine = Play(LivelySimulator().get(), 0, 45); });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(seen[0], expected);
  EXPECT_EQ(seen[1], expected);
}

/// Something that a confused skill might want.
robot::Command RandomCommand(base::Rng* rng) {
  robot::Command command;
  const auto& arm = Pr2().profile.upper_body->arms.at("rightarm1");
  const int kind = rng->Index(4);
  if (kind == 0) return Gripper(rng->Uniform(-0.01, 0.12), rng->Uniform(-1.0, 60.0));
  if (kind == 1) return TorsoTo(rng->Uniform(-0.1, 0.5));
  if (kind == 2) {
    command.base_velocity =
        geometry::Twist2{rng->Uniform(-0.5, 0.5), rng->Uniform(-0.5, 0.5), rng->Uniform(-1, 1)};
    return command;
  }
  robot::JointTrajectory trajectory{arm.joints, {}};
  for (int i = rng->Index(4); i > 0; --i) {
    robot::TrajectoryPoint point;
    point.time = trajectory.duration() + rng->Uniform(0.01, 1.0);
    for (std::size_t k = 0; k < arm.joints.size(); ++k) {
      point.positions.push_back(rng->Uniform(-4.0, 4.0));
      point.velocities.push_back(rng->Uniform(-3.0, 3.0));
    }
    trajectory.points.push_back(point);
  }
  command.trajectories["rightarm1"] = trajectory;
  return command;
}

TEST(PlanarSimulatorTest, WhateverIsCommandedTheStateStaysSound) {
  for (int seed = 0; seed < 20; ++seed) {
    const auto simulator =
        Simulator({MugAt(), MugAt({0.0, 0.2}, "mug2"), MugAt({0.12, 0.0}, "mug3")}, Lively());
    base::Rng rng(seed);
    for (int i = 0; i < 60; ++i) {
      simulator->Send(RandomCommand(&rng));
      StepFor(simulator.get(), 0.1);
      for (const double number : Bits(simulator.get())) ASSERT_TRUE(std::isfinite(number)) << seed;
      for (const auto& object : simulator->GetWorldState().objects) {
        ASSERT_LT(object.X_MO.translation.norm(), 30.0) << object.name << " at seed " << seed;
        ASSERT_GT(object.X_MO.translation.z(), -0.06) << object.name << " at seed " << seed;
      }
      // What comes out can be put in again.
      ASSERT_NO_THROW(robot::ForwardKinematics(Pr2().model, simulator->GetRobotState().joints));
    }
  }
}

// -------------------------------------------------------------------------------------- robot

TEST(PlanarSimulatorTest, LinksAreWhereForwardKinematicsHasThem) {
  const auto simulator = Simulator({});
  simulator->Send(JointTo("rightarm1", "r_shoulder_pan_joint", 0.4, 0.8));
  simulator->Send(TorsoTo(0.2));
  simulator->Send(Gripper(0.03));
  for (int i = 0; i < 20; ++i) {
    StepFor(simulator.get(), 0.1);
    const auto joints = simulator->GetRobotState().joints;
    const auto X_R = robot::ForwardKinematics(Pr2().model, joints);
    for (const char* link : {"r_gripper_palm_link", "r_gripper_r_finger_tip_link",
                             "l_gripper_tool_frame", "head_mount_kinect_ir_link"}) {
      const geometry::Pose3& X_RL = X_R[*Pr2().model.FindLink(link)];
      const geometry::Pose3 X_ML = simulator->X_MLink(link);
      EXPECT_LT((X_ML.translation - X_RL.translation).norm(), 1e-9) << link;
      EXPECT_LT(X_ML.rotation.angularDistance(X_RL.rotation), 1e-7) << link;
    }
  }
}

TEST(PlanarSimulatorTest, StateComesOutAsItWentIn) {
  const robot::RobotState state = ReadyState(0.05);
  const auto joints = Simulator({}, {}, state)->GetRobotState().joints;
  for (const auto& [name, position] : state.joints) EXPECT_EQ(joints.at(name), position) << name;
  EXPECT_EQ(joints.at("l_shoulder_pan_joint"), 0.06024);  // not named: as while driving
  EXPECT_GT(joints.at("r_gripper_l_finger_joint"), 0.2);  // follows from the gap
}

TEST(PlanarSimulatorTest, AnArmPushesWhatStandsInItsWay) {
  const auto simulator = Simulator({MugAt({0.0, 0.16})});
  StepFor(simulator.get(), 0.1);
  simulator->Send(JointTo("rightarm1", "r_shoulder_pan_joint", 0.4, 1.0));
  StepFor(simulator.get(), 2.0);
  EXPECT_GT(simulator->PoseOf(0).translation.y(), kToolY + 0.25);
}

TEST(PlanarSimulatorTest, AnArmOnTheTableIsAContact) {
  const auto simulator = Simulator({});
  StepFor(simulator.get(), 0.1);
  EXPECT_FALSE(simulator->contact());
  simulator->Send(TorsoTo(kTorso - 0.06));
  StepFor(simulator.get(), 5.0);
  ASSERT_TRUE(simulator->contact());
  EXPECT_THAT(simulator->contact()->robot_part, HasSubstr("r_"));
  EXPECT_EQ(simulator->contact()->obstacle, "table1");
}

TEST(PlanarSimulatorTest, TheTrayLevelHasTheShapeOfTheJoints) {
  // With an arm stretched out the robot reaches farther, at either level.
  world::World room = test_support::Room();
  room.statics = {test_support::Block("pillar", {0.1, 0.1, 2.0}, {0.9, kToolY, 1.0})};
  const auto scene = MakeScene(room, Pr2());
  const auto refusal = [&](const robot::RobotState& state, LevelOfDetail level) {
    return ConfigErrorOf([&] { RobotSimulator(scene, {}, {}, state, base::Rng(1), {}, level); });
  };
  robot::RobotState state = ReadyState();
  state.X_MB.x = 0.1;
  for (const LevelOfDetail level : {LevelOfDetail::kTray, LevelOfDetail::kPlanar}) {
    EXPECT_THAT(refusal(state, level), AllOf(HasSubstr("r_"), HasSubstr("'pillar'")));
    robot::RobotState tucked = state;
    tucked.joints.clear();
    EXPECT_THAT(refusal(tucked, level), HasSubstr("no ConfigError"));
  }
}

TEST(PlanarSimulatorTest, AnArmMayReachOverThings) {
  // The upper arm rises over a pillar that ends at the shoulder's height.
  robot::RobotState state = ReadyState();
  state.joints["r_shoulder_lift_joint"] = -0.4;
  state.joints["r_elbow_flex_joint"] = -0.5;
  const double shoulder = 0.790675 + kTorso;
  for (const double too_high : {0.0, 0.12}) {
    world::World room = test_support::Room();
    const double height = shoulder + too_high;
    room.statics = {
        test_support::Block("pillar", {0.04, 0.04, height}, {0.42, kToolY, height / 2})};
    for (const LevelOfDetail level : {LevelOfDetail::kTray, LevelOfDetail::kPlanar}) {
      const std::string refusal = ConfigErrorOf(
          [&] { RobotSimulator(MakeScene(room, Pr2()), {}, {}, state, base::Rng(1), {}, level); });
      EXPECT_THAT(refusal, HasSubstr(too_high > 0.0 ? "'pillar'" : "no ConfigError"));
    }
  }
}

TEST(PlanarSimulatorTest, RefusesARobotWithoutUpperBody) {
  EXPECT_THAT(ConfigErrorOf([] {
                RobotSimulator(test_support::RoomScene(), {}, {},
                               test_support::StandingAt({3.0, 2.0, 0.0}), base::Rng(1), {},
                               LevelOfDetail::kPlanar);
              }),
              AllOf(HasSubstr("no upper body"), HasSubstr("upper_body")));
}

TEST(PlanarSimulatorTest, TakesJointsAsDriversMeasureThem) {
  robot::RobotState state = ReadyState();
  state.joints["r_gripper_r_finger_joint"] = 0.3;  // follows another
  state.joints["torso_lift_joint"] = -0.001;       // a little too low
  state.joints["fl_caster_rotation_joint"] = 1.0;
  state.joints.erase("r_shoulder_lift_joint");  // the arm not above the table
  state.joints.erase("r_elbow_flex_joint");
  for (const LevelOfDetail level : {LevelOfDetail::kTray, LevelOfDetail::kPlanar}) {
    RobotSimulator simulator(
        MakeScene(test_support::Room(), Pr2()), {}, {},
        [&] {
          robot::RobotState middle = state;
          middle.X_MB = {3.0, 2.0, 0.0};
          return middle;
        }(),
        base::Rng(1), {}, level);
    const auto joints = simulator.GetRobotState().joints;
    EXPECT_EQ(joints.count("r_gripper_r_finger_joint"), 0u);
    EXPECT_EQ(joints.at("torso_lift_joint"), 0.0);
    EXPECT_EQ(joints.at("fl_caster_rotation_joint"), 1.0);
  }
}

TEST(PlanarSimulatorTest, NoisyEncodersStayWithinTheLimits) {
  Variation variation;
  variation.encoder_noise = 0.05;
  robot::RobotState state = ReadyState(0.0);
  const auto simulator = Simulator({}, variation, state);
  for (int i = 0; i < 500; ++i) {
    const auto joints = simulator->Observe(0.0).joints;
    ASSERT_NO_THROW(robot::ForwardKinematics(Pr2().model, joints));
    ASSERT_EQ(joints.at("r_gripper_joint"), 0.0);
  }
}

TEST(PlanarSimulatorTest, RefusesJointsBeyondTheirLimits) {
  robot::RobotState state = ReadyState();
  state.joints["r_elbow_flex_joint"] = 0.5;
  EXPECT_THAT(ConfigErrorOf([&] { Simulator({}, {}, state); }),
              AllOf(HasSubstr("r_elbow_flex_joint"), HasSubstr("-2.3213")));
}

TEST(PlanarSimulatorTest, RefusesUnknownGroupsAndHands) {
  const auto simulator = Simulator({});
  robot::Command command;
  command.grippers["rightarm"] = {0.0, -1.0};
  EXPECT_THAT(ConfigErrorOf([&] { simulator->Send(command); }),
              AllOf(HasSubstr("arm 'rightarm' is unknown"), HasSubstr("'rightarm1'")));
  EXPECT_THAT(ConfigErrorOf([&] { simulator->Send(JointTo("neck", "head_pan_joint", 0, 1)); }),
              HasSubstr("'neck' is unknown"));
}

// ------------------------------------------------------------------------------------- seeing

/// The head looks down at the table.
robot::RobotState Looking(double tilt = 0.7) {
  robot::RobotState state = ReadyState();
  // The arm out of the way.
  for (const char* joint : {"r_shoulder_pan_joint", "r_shoulder_lift_joint", "r_elbow_flex_joint",
                            "r_wrist_flex_joint"}) {
    state.joints.erase(joint);
  }
  state.joints.erase("r_upper_arm_roll_joint");
  state.joints.erase("r_forearm_roll_joint");
  state.joints.erase("r_wrist_roll_joint");
  state.joints["head_tilt_joint"] = tilt;
  return state;
}

world::ObjectState MugOnTable(double x, double y) {
  world::ObjectState mug = MugAt();
  mug.X_MO.translation = {x, y, kTableTop + 0.0002};
  return mug;
}

TEST(PlanarSimulatorTest, TheCameraFindsWhatItLooksAt) {
  const auto simulator = Simulator({MugOnTable(1.2, 0.1)}, {}, Looking());
  EXPECT_THAT(simulator->Observe(0.0).objects, IsEmpty());
  StepFor(simulator.get(), 0.6);
  const auto seen = simulator->Observe(0.0).objects;
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_EQ(seen[0].name, "mug1");
  EXPECT_EQ(seen[0].model, "mug");
  // The camera leans with the base, which the robot does not know.
  EXPECT_LT((seen[0].X_MO.translation - simulator->PoseOf(0).translation).norm(), 5e-4);
  EXPECT_THAT(seen[0].attached_to, IsEmpty());
}

TEST(PlanarSimulatorTest, WhatIsBehindItIsNotFound) {
  const auto simulator = Simulator({MugOnTable(1.2, 0.1)}, {}, Looking(-0.4));
  StepFor(simulator.get(), 2.0);
  EXPECT_THAT(simulator->Observe(0.0).objects, IsEmpty());
}

TEST(PlanarSimulatorTest, WhatIsRememberedStaysUntilItIsMissed) {
  const auto simulator = Simulator({}, {}, Looking(-0.4));
  robot::SeenObject told;
  told.name = "Mug7";
  told.model = "mug";
  told.X_MO.translation = {1.2, 0.1, kTableTop};
  simulator->Remember({told});
  StepFor(simulator.get(), 2.0);
  ASSERT_EQ(simulator->Observe(0.0).objects.size(), 1u);  // it did not look there
  EXPECT_EQ(simulator->Observe(0.0).objects[0].name, "mug7");
  simulator->Send(JointTo("head", "head_tilt_joint", 0.7, 0.5));
  StepFor(simulator.get(), 3.0);  // three looks
  EXPECT_THAT(simulator->Observe(0.0).objects, IsEmpty());
}

TEST(PlanarSimulatorTest, RefusesToRememberWhatCannotBe) {
  const auto simulator = Simulator({});
  robot::SeenObject told{"mug1", "mgu", {}, 0.0, ""};
  EXPECT_THAT(ConfigErrorOf([&] { simulator->Remember({told}); }),
              AllOf(HasSubstr("'mug1'"), HasSubstr("model 'mgu' is unknown")));
  told.model = "mug";
  told.X_MO.translation.x() = NAN;
  EXPECT_THAT(ConfigErrorOf([&] { simulator->Remember({told}); }),
              AllOf(HasSubstr("'mug1'"), HasSubstr("not finite")));
}

TEST(PlanarSimulatorTest, WhatStandsOnTheTrayIsKnownToDriveAlong) {
  world::ObjectState mill;
  mill.name = "mill1";
  mill.model = "mill";
  mill.X_MO.translation = {0.28, 0.0, 0.3464};
  world::ObjectState on_table = MugOnTable(1.2, 0.1);
  robot::RobotState state;
  state.joints["torso_lift_joint"] = 0.29;
  const auto simulator = Simulator({mill, on_table}, {}, state);
  robot::SeenObject told{"mill1", "mill", mill.X_MO, 0.0, ""};
  robot::SeenObject told_too{"mug1", "mug", on_table.X_MO, 0.0, ""};
  simulator->Remember({told, told_too});
  robot::Command drive;
  drive.base_velocity = geometry::Twist2{-0.2, 0.1, 0.3};
  for (int i = 0; i < 40; ++i) {
    simulator->Send(drive);
    StepFor(simulator.get(), 0.05);
  }
  const auto seen = simulator->Observe(0.0).objects;
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_GT((seen[0].X_MO.translation - mill.X_MO.translation).norm(), 0.3);
  EXPECT_LT((seen[0].X_MO.translation - simulator->PoseOf(0).translation).norm(), 0.005);
  EXPECT_LT((seen[1].X_MO.translation - on_table.X_MO.translation).norm(), 1e-9);
}

TEST(PlanarSimulatorTest, WhatTheHandHoldsNobodyNeedsToTell) {
  world::ObjectState mug = MugAt();
  mug.attached_to = "r_gripper_palm_link";
  const auto simulator = Simulator({mug}, {}, Looking(-0.4));
  robot::SeenObject held, free;
  held.name = "mug1";
  held.model = free.model = "mug";
  held.attached_to = free.attached_to = "r_gripper_palm_link";
  free.name = "mug2";
  simulator->Remember({held, free});
  const auto seen = simulator->Observe(0.0).objects;
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_EQ(seen[0].attached_to, "r_gripper_palm_link");
  EXPECT_LT((seen[0].X_MO.translation - simulator->PoseOf(0).translation).norm(), 1e-9);
  EXPECT_THAT(seen[1].attached_to, IsEmpty());
}

TEST(PlanarSimulatorTest, WhatIsHeldIsKnownWhereTheHandIs) {
  const auto simulator = Simulator({MugAt()});
  simulator->Remember({{"mug1", "mug", MugAt().X_MO, 0.0, ""}});
  simulator->Send(Gripper(0.0));
  StepFor(simulator.get(), 1.0);
  simulator->Send(JointTo("rightarm1", "r_shoulder_pan_joint", 0.4, 1.0));
  StepFor(simulator.get(), 2.0);
  auto seen = simulator->Observe(0.0).objects;
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_EQ(seen[0].attached_to, "r_gripper_palm_link");
  EXPECT_LT((seen[0].X_MO.translation - simulator->PoseOf(0).translation).norm(), 0.005);
  simulator->Send(Gripper(0.09));
  StepFor(simulator.get(), 0.4);
  seen = simulator->Observe(0.0).objects;
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_THAT(seen[0].attached_to, IsEmpty());
}

TEST(PlanarSimulatorTest, EncodersAndDetectionsHaveTheirNoise) {
  Variation variation;
  variation.encoder_noise = 0.002;
  const auto simulator = Simulator({}, variation);
  double sum = 0.0, squares = 0.0;
  const int count = 2000;
  const double truth = simulator->GetRobotState().joints.at("r_elbow_flex_joint");
  for (int i = 0; i < count; ++i) {
    const double off = simulator->Observe(0.0).joints.at("r_elbow_flex_joint") - truth;
    sum += off;
    squares += off * off;
  }
  EXPECT_NEAR(sum / count, 0.0, 4.0 * 0.002 / std::sqrt(count));
  EXPECT_NEAR(std::sqrt(squares / count), 0.002, 0.002 * 4.0 / std::sqrt(2.0 * count));
}

}  // namespace
}  // namespace hires::simulation::planar_simulator_test
