#include "imagination/rollout/load_monitor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "hires/imagination/rollout.h"
#include "support/rounds.h"
#include "support/scenes.h"

namespace hires::imagination::load_monitor_test {
namespace {

using hires::test_support::AddModel;
using hires::test_support::OnTray;
using hires::test_support::RoomScene;
using hires::test_support::StandingAt;
using simulation::RobotSimulator;

const geometry::Pose2 kStart{2.0, 2.0, 0.0};

/// A simulator with a load, and its monitor.
struct Watched {
  explicit Watched(const std::vector<std::string>& models, const RolloutParams& rollout = {},
                   const world::StandingCriterion& standing = {},
                   const simulation::Variation& variation = {})
      : Watched(LoadOf(models), rollout, standing, variation) {}
  explicit Watched(const world::WorldState& objects, const RolloutParams& rollout = {},
                   const world::StandingCriterion& standing = {},
                   const simulation::Variation& variation = {}, const Purpose& purpose = {},
                   const std::shared_ptr<const simulation::Scene>& scene = RoomScene())
      : params(rollout),
        simulator(scene, variation, objects, StandingAt(kStart), base::Rng(1)),
        monitor(&simulator, params, standing, purpose) {}

  static world::WorldState LoadOf(const std::vector<std::string>& models) {
    world::WorldState load;
    for (const std::string& model : models) {
      const double y = 0.13 * static_cast<double>(load.objects.size());
      load.objects.push_back(
          OnTray("load" + std::to_string(load.objects.size()), model, kStart, {0.0, y}));
    }
    return load;
  }

  void Drive(double vx, double vy, double duration) {
    for (long i = std::lround(duration / 0.01); i > 0; --i) {
      robot::Command command;
      command.base_velocity = geometry::Twist2{vx, vy, 0.0};
      simulator.Send(command);
      for (int step = 0; step < 10; ++step) simulator.Step();
      monitor.Look();
      counts += monitor.Sample();
    }
  }

  RolloutParams params;
  RobotSimulator simulator;
  LoadMonitor monitor;
  OutcomeCounts counts;
};

TEST(LoadMonitorTest, ALoadAtRestDoesNotShake) {
  Watched watched({"mill"});
  watched.Drive(0.0, 0.0, 1.0);
  EXPECT_EQ(watched.counts.notopple, 100);
  EXPECT_LT(watched.monitor.max_tilt(), 0.001);
  EXPECT_EQ(watched.monitor.falls(), 0);
  EXPECT_EQ(ToString(watched.monitor.WhyNotWell()), "");
  EXPECT_EQ(watched.monitor.first_cause(), "");
  EXPECT_FALSE(watched.monitor.is_lost());
}

TEST(LoadMonitorTest, WithoutALoadThereIsNothingToCount) {
  Watched watched(world::WorldState{});
  watched.Drive(0.8, 0.0, 0.5);
  EXPECT_FALSE(watched.monitor.watches_something());
  EXPECT_EQ(watched.counts.total(), 0);
  EXPECT_EQ(watched.monitor.tilt(), 0.0);
}

TEST(LoadMonitorTest, AFallIsCountedOnceWithItsCause) {
  Watched watched({"tower"});
  watched.Drive(0.0, 0.9, 0.6);
  watched.Drive(0.0, 0.0, 1.5);
  EXPECT_EQ(watched.monitor.falls(), 1);
  EXPECT_EQ(watched.monitor.first_cause(), "accelerating");
  EXPECT_GT(watched.counts.notopple, 0);
  EXPECT_GT(watched.counts.shaking, 0);
  EXPECT_GT(watched.counts.topple, 10);
  EXPECT_GT(watched.monitor.max_tilt(), 1.0);
  EXPECT_EQ(ToString(watched.monitor.WhyNotWell()), "object_fell: load0");
}

TEST(LoadMonitorTest, BrakingIsTheCauseWhenItShakesFirstThen) {
  Watched watched({"tower"});
  // Up slowly, by 0.09 m/s every 0.1 s: 0.9 m/s^2 on average, then at once down.
  for (int i = 1; i <= 8; ++i) {
    for (int part = 0; part < 10; ++part) watched.Drive(0.0, 0.08 * i - 0.08 + 0.008 * part, 0.01);
  }
  watched.Drive(0.0, 0.64, 0.5);
  ASSERT_EQ(watched.monitor.first_cause(), "") << "the start was to be gentle";
  watched.Drive(0.0, 0.0, 1.0);
  EXPECT_EQ(watched.monitor.first_cause(), "braking");
}

TEST(LoadMonitorTest, TheObjectThatLeansMostCounts) {
  Watched watched({"tower", "mill"});  // 2 m/s^2: the tower falls, the mill stands
  watched.Drive(0.0, 0.9, 0.6);
  watched.Drive(0.0, 0.0, 1.5);
  EXPECT_EQ(watched.monitor.falls(), 1);
  EXPECT_GT(watched.counts.topple, 0);
  EXPECT_EQ(ToString(watched.monitor.WhyNotWell()), "object_fell: load0");
}

TEST(LoadMonitorTest, AllThatFellAreNamed) {
  Watched watched({"tower", "tower"});
  watched.Drive(0.0, 0.9, 0.6);
  watched.Drive(0.0, 0.0, 1.5);
  EXPECT_EQ(watched.monitor.falls(), 2);
  EXPECT_EQ(ToString(watched.monitor.WhyNotWell()), "object_fell: load0, load1");
}

TEST(LoadMonitorTest, WhatSlidesFarEnoughHasFallen) {
  world::StandingCriterion strict;
  strict.slide = 0.02;
  simulation::Variation slippery;
  slippery.friction_factor = 0.1;
  Watched watched({"mill"}, {}, strict, slippery);
  watched.Drive(0.0, 0.9, 0.4);
  EXPECT_EQ(watched.monitor.falls(), 1);
  EXPECT_EQ(ToString(watched.monitor.WhyNotWell()), "object_slid: load0");
  EXPECT_LT(watched.monitor.max_tilt(), 0.1);
}

TEST(LoadMonitorTest, WhatSlidesOffTheTrayFellAndFellOnce) {
  world::World room = hires::test_support::Room();
  hires::test_support::AddModel(&room, hires::test_support::Mill("puck", 0.02, 0.04, 0.3, 0.05));
  RobotSimulator simulator(simulation::MakeScene(room, hires::test_support::TrayRobot()), {},
                           {{OnTray("puck1", "puck", kStart)}}, StandingAt(kStart), base::Rng(1));
  const RolloutParams params;
  LoadMonitor monitor(&simulator, params, {});
  std::vector<std::string> seen;  // what was not well, in its order
  bool is_waited_for = true;      // from the slide until it lies
  for (int step = 0; step < 3000; ++step) {
    robot::Command command;
    command.base_velocity = geometry::Twist2{0.0, 0.9, 0.0};
    simulator.Send(command);
    simulator.Step();
    monitor.Look();
    const std::string why = ToString(monitor.WhyNotWell());
    if (!why.empty() && (seen.empty() || seen.back() != why)) seen.push_back(why);
    if (why == "object_slid: puck1") is_waited_for = is_waited_for && !monitor.IsSettled();
  }
  EXPECT_THAT(seen, testing::ElementsAre("object_slid: puck1", "object_fell: puck1"));
  EXPECT_TRUE(is_waited_for) << "what slides may fall yet";
  EXPECT_EQ(monitor.falls(), 1);
  EXPECT_THAT(monitor.Down(), testing::ElementsAre("puck1"));
}

TEST(LoadMonitorTest, WhatFallsIsNamedRatherThanWhatSlidBefore) {
  world::World room = hires::test_support::Room();
  hires::test_support::AddModel(&room, hires::test_support::Mill("puck", 0.02, 0.04, 0.3, 0.05));
  const world::WorldState load{
      {OnTray("puck1", "puck", kStart), OnTray("tower1", "tower", kStart, {0.0, 0.13})}};
  RobotSimulator simulator(simulation::MakeScene(room, hires::test_support::TrayRobot()), {}, load,
                           StandingAt(kStart), base::Rng(1));
  world::StandingCriterion strict;
  strict.slide = 0.02;
  const RolloutParams params;
  LoadMonitor monitor(&simulator, params, strict);
  std::vector<std::string> seen;  // what was not well, in its order
  for (int step = 0; step < 2000; ++step) {
    robot::Command command;
    command.base_velocity = geometry::Twist2{0.0, step < 600 ? 0.9 : 0.0, 0.0};
    simulator.Send(command);
    simulator.Step();
    monitor.Look();
    const std::string why = ToString(monitor.WhyNotWell());
    if (!why.empty() && (seen.empty() || seen.back() != why)) seen.push_back(why);
  }
  EXPECT_THAT(seen, testing::ElementsAre("object_slid: puck1", "object_fell: tower1",
                                         "object_fell: puck1, tower1"));
  EXPECT_EQ(monitor.falls(), 2);
}

/// A puck on the tray that chance throws while it settles: it stays there, or comes to lie or to
/// stand elsewhere.
struct Thrown {
  explicit Thrown(base::Rng rng, const RolloutParams& rollout = {}) : params(rollout) {
    world::World room = hires::test_support::Room();
    hires::test_support::AddModel(&room, hires::test_support::Mill("puck", 0.03, 0.06, 0.3, 0.3));
    world::ObjectState puck = OnTray("Puck1", "puck", kStart);
    const double direction = rng.Uniform(-M_PI, M_PI), speed = rng.Uniform(0.0, 4.0);
    puck.V_MO.linear = speed * Eigen::Vector3d(std::cos(direction), std::sin(direction), 0.0);
    simulator.emplace(simulation::MakeScene(room, hires::test_support::TrayRobot()),
                      simulation::Variation{}, world::WorldState{{puck}}, StandingAt(kStart),
                      base::Rng(1));
    for (int step = 0; step < 1500; ++step) simulator->Step();
    X_BO = {geometry::Lift(kStart).Inverse() * puck.X_MO};
    // The top of the base's box is at 0.30 m, that of the tray 0.05 m higher.
    is_on_robot = simulator->PoseOf(0).translation.z() > 0.29;
    tilt = geometry::TiltOf(simulator->PoseOf(0).rotation);
    monitor.emplace(&*simulator, params, standing, Purpose{}, X_BO);
  }

  RolloutParams params;
  world::StandingCriterion standing;
  std::optional<RobotSimulator> simulator;
  std::vector<geometry::Pose3> X_BO;
  std::optional<LoadMonitor> monitor;
  bool is_on_robot{false};  // when it has settled
  double tilt{0.0};         // then
};

TEST(LoadMonitorTest, WhatFellOffTheRobotWhileItSettledHasFallenUprightOrNot) {
  int stayed = 0, stands_elsewhere = 0;
  for (int round = 0; round < hires::test_support::Rounds(120); ++round) {
    Thrown thrown(base::Rng(3).Fork(round));
    if (thrown.tilt > 0.01 && thrown.tilt < 0.6) continue;  // it leans against something
    const bool is_well = thrown.tilt <= 0.1 && thrown.is_on_robot;
    LoadMonitor& monitor = *thrown.monitor;
    for (int look = 0; look < 3; ++look) {
      monitor.Look();
      for (int step = 0; step < 5; ++step) thrown.simulator->Step();
    }
    monitor.Conclude();
    EXPECT_TRUE(monitor.watches_something());
    EXPECT_EQ(monitor.falls(), is_well ? 0 : 1) << "round " << round;
    EXPECT_EQ(ToString(monitor.WhyNotWell()), is_well ? "" : "object_fell: puck1");
    EXPECT_EQ(monitor.Down().size(), is_well ? 0u : 1u);
    stayed += is_well ? 1 : 0;
    stands_elsewhere += !is_well && thrown.tilt <= 0.1 ? 1 : 0;
  }
  EXPECT_GT(stayed, 1);
  EXPECT_GT(stands_elsewhere, 1) << "what lies was always told";
}

TEST(LoadMonitorTest, WhatFellWhileItSettledIsPutBack) {
  RolloutParams params;
  params.put_back = true;
  int put_back = 0;
  for (int round = 0; round < 30; ++round) {
    Thrown thrown(base::Rng(3).Fork(round), params);
    if (thrown.is_on_robot || thrown.tilt > 0.1) continue;
    EXPECT_EQ(thrown.monitor->falls(), 1);
    EXPECT_NEAR(thrown.simulator->PoseOf(0).translation.z(), hires::test_support::kTrayTop, 0.001);
    ++put_back;
  }
  EXPECT_GT(put_back, 0);
}

TEST(LoadMonitorTest, PutBackItStandsAndCountsAgain) {
  RolloutParams params;
  params.put_back = true;
  params.put_back_tilt = 0.6;
  Watched watched({"tower"}, params);
  for (int i = 0; i < 3; ++i) {
    watched.Drive(0.0, 0.8, 0.8);
    watched.Drive(0.0, -0.8, 0.8);
  }
  EXPECT_GT(watched.monitor.falls(), 2);
  watched.Drive(0.0, 0.0, 2.0);
  const int falls = watched.monitor.falls();
  watched.Drive(0.0, 0.0, 1.0);
  EXPECT_EQ(watched.monitor.falls(), falls);
  EXPECT_LT(watched.monitor.tilt(), 0.05) << "it stands again";
}

TEST(LoadMonitorTest, SamplesAreCutAtTheirThresholds) {
  RolloutParams strict;
  strict.shaking_tilt = 0.0;
  Watched wobbling({"mill"}, strict);
  wobbling.Drive(0.3, 0.0, 0.2);
  EXPECT_GT(wobbling.counts.shaking, 0);
  RolloutParams lax;
  lax.shaking_tilt = 0.4;
  Watched calm({"mill"}, lax);
  calm.Drive(0.3, 0.0, 0.2);
  EXPECT_EQ(calm.counts.notopple, 20);
}

TEST(SampleOfTest, ThresholdsBelongToTheirOuterClass) {
  RolloutParams params;
  params.shaking_tilt = 0.01;
  params.topple_tilt = 0.5;
  EXPECT_EQ(SampleOf(0.01, params), (OutcomeCounts{1, 0, 0}));
  EXPECT_EQ(SampleOf(0.0101, params), (OutcomeCounts{0, 1, 0}));
  EXPECT_EQ(SampleOf(0.4999, params), (OutcomeCounts{0, 1, 0}));
  EXPECT_EQ(SampleOf(0.5, params), (OutcomeCounts{0, 0, 1}));
}

// ----------------------------------------------------------------- what an action is about

/// An object on the floor, `x` m before the robot.
world::ObjectState OnFloor(const std::string& name, const std::string& model, double x) {
  world::ObjectState object;
  object.name = name;
  object.model = model;
  object.X_MO.translation = {kStart.x + x, kStart.y, 0.0002};
  return object;
}

Watched WithPurpose(const world::WorldState& objects, Purpose::Kind kind,
                    const std::string& object) {
  return Watched(objects, {}, {}, {}, {kind, object, "rightarm1", "east"});
}

TEST(LoadMonitorTest, ABystanderThatIsKnockedOverIsNamed) {
  world::WorldState objects{{OnFloor("Tower1", "tower", 0.6), OnFloor("mill1", "mill", 1.6)}};
  Watched watched(objects);
  EXPECT_FALSE(watched.monitor.watches_something()) << "they are none of its business";
  watched.Drive(0.8, 0.0, 0.8);
  watched.Drive(0.0, 0.0, 1.5);
  EXPECT_EQ(watched.counts.total(), 0);
  EXPECT_EQ(watched.monitor.falls(), 0);
  watched.monitor.Conclude();
  EXPECT_EQ(ToString(watched.monitor.WhyNotWell()), "knocked_over: tower1");
  EXPECT_EQ(watched.monitor.falls(), 1);
  EXPECT_TRUE(watched.monitor.IsSettled());
}

TEST(LoadMonitorTest, WhatLiesFromTheStartWasNotKnockedOver) {
  world::ObjectState lying = OnFloor("tower1", "tower", 1.2);
  lying.X_MO.rotation = geometry::RotationFromRpy(1.5707963267948966, 0.0, 0.0);
  lying.X_MO.translation.z() = 0.038;
  Watched watched(world::WorldState{{lying}});
  watched.Drive(0.0, 0.0, 0.5);
  watched.monitor.Conclude();
  EXPECT_EQ(ToString(watched.monitor.WhyNotWell()), "");
}

TEST(LoadMonitorTest, NothingIsSettledWhileABystanderMoves) {
  world::ObjectState sliding = OnFloor("mill1", "mill", 1.2);
  sliding.V_MO.linear.x() = 0.3;
  Watched watched(world::WorldState{{sliding}});
  watched.Drive(0.0, 0.0, 0.01);
  EXPECT_FALSE(watched.monitor.IsSettled());
  watched.Drive(0.0, 0.0, 2.0);
  EXPECT_TRUE(watched.monitor.IsSettled());
  EXPECT_EQ(ToString(watched.monitor.WhyNotWell()), "");
}

// ----------------------------------------------------------------- what rolls

constexpr double kBallRadius = 0.1;

/// The room with a ball, whose origin is its middle.
std::shared_ptr<const simulation::Scene> SceneWithBall() {
  world::World room = hires::test_support::Room();
  const geometry::Sphere sphere{kBallRadius};
  world::ObjectModel ball;
  ball.name = "ball";
  ball.mass_properties = {0.4, Eigen::Vector3d::Zero(), geometry::SolidInertia(sphere, 0.4)};
  ball.collisions.push_back(hires::test_support::Shape("ball", sphere, Eigen::Vector3d::Zero()));
  AddModel(&room, ball);
  ball.name = "lifted_ball";  // its origin is its lowest point
  ball.mass_properties.p_BBcm.z() = ball.collisions[0].X_BS.translation.z() = kBallRadius;
  AddModel(&room, ball);
  room.hash = room.ComputeHash();
  return simulation::MakeScene(std::move(room), hires::test_support::TrayRobot());
}

world::ObjectState BallAt(const std::string& name, double x, double y = 0.0) {
  world::ObjectState ball = OnFloor(name, "ball", x);
  ball.X_MO.translation.y() += y;
  ball.X_MO.translation.z() = kBallRadius;
  return ball;
}

/// All that a rollout draws of loose things, off.
simulation::Variation Off() {
  simulation::Variation off;
  off.com_offset = {0.002, -0.001};
  off.com_height_factor = 1.1;
  off.radius_factor = 0.9;
  off.friction_factor = 0.5;
  return off;
}

TEST(LoadMonitorTest, ABallThatNothingTouchesStaysWhereItIsWhateverIsDrawn) {
  world::ObjectState turned = BallAt("ball2", 1.2, 0.8);
  turned.X_MO.rotation = geometry::RotationFromRpy(1.2, 0.4, 0.3);
  world::ObjectState lifted = BallAt("ball3", 1.2, -0.8);
  lifted.model = "lifted_ball";
  lifted.X_MO.translation.z() = 0.0;
  world::ObjectState lying = OnFloor("mill1", "mill", 2.5);
  lying.X_MO.rotation = geometry::RotationFromRpy(0.0, 1.5707963267948966, 0.0);
  lying.X_MO.translation.z() = 0.037;
  const world::WorldState objects{{BallAt("ball1", 1.2), turned, lifted, lying}};
  Watched watched(objects, {}, {}, Off(), {}, SceneWithBall());
  watched.Drive(0.3, 0.0, 0.5);
  watched.Drive(0.0, 0.0, 5.0);
  watched.monitor.Conclude();
  EXPECT_EQ(ToString(watched.monitor.WhyNotWell()), "");
  EXPECT_EQ(watched.monitor.falls(), 0);
  for (int i = 0; i < 4; ++i) {
    const geometry::Pose3 X_MO = watched.simulator.PoseOf(i);
    EXPECT_LT((X_MO.translation - objects.objects[i].X_MO.translation).norm(), 0.001);
    EXPECT_LT(X_MO.rotation.angularDistance(objects.objects[i].X_MO.rotation), 0.001);
    EXPECT_FALSE(watched.simulator.IsReached(i));
  }
}

TEST(LoadMonitorTest, ABallThatTheRobotHitsRollsAndIsNamedHoweverItIsTurned) {
  for (const double roll : {0.0, 1.2}) {
    world::ObjectState ball = BallAt("ball1", 0.6);
    ball.X_MO.rotation = geometry::RotationFromRpy(roll, 0.0, 0.0);
    const world::WorldState objects{{ball, BallAt("ball2", 1.2), BallAt("ball3", 1.2, 1.0)}};
    Watched watched(objects, {}, {}, Off(), {}, SceneWithBall());
    watched.Drive(0.8, 0.0, 0.8);
    watched.Drive(0.0, 0.0, 1.5);
    watched.monitor.Conclude();
    EXPECT_GT(watched.simulator.PoseOf(0).translation.x(), ball.X_MO.translation.x() + 0.2);
    EXPECT_EQ(ToString(watched.monitor.WhyNotWell()), "knocked_over: ball1, ball2")
        << "the second was hit by the first";
    EXPECT_EQ(watched.monitor.falls(), 2);
  }
}

TEST(LoadMonitorTest, WhatMovesByItselfIsNoFallUntilTheRobotReachesIt) {
  world::ObjectState rolling = BallAt("ball1", 1.2);
  rolling.V_MO.linear.y() = 0.3;
  rolling.V_MO.angular.x() = -3.0;
  world::ObjectState tips = OnFloor("tower1", "tower", 2.0);
  tips.V_MO.angular.x() = 6.0;
  Watched watched({{rolling, tips}}, {}, {}, {}, {}, SceneWithBall());
  watched.Drive(0.0, 0.0, 2.0);
  EXPECT_GT(watched.simulator.PoseOf(0).translation.y(), kStart.y + 0.3);
  EXPECT_GT(geometry::TiltOf(watched.simulator.PoseOf(1).rotation), 1.0);
  watched.monitor.Conclude();
  EXPECT_EQ(ToString(watched.monitor.WhyNotWell()), "");
  EXPECT_EQ(watched.monitor.falls(), 0);
}

TEST(LoadMonitorTest, WhatTheActionHandlesIsWatchedWhereverItStands) {
  Watched watched = WithPurpose({{OnFloor("mill1", "mill", 1.2)}}, Purpose::Kind::kTake, "mill1");
  EXPECT_TRUE(watched.monitor.watches_something());
  watched.Drive(0.0, 0.0, 0.2);
  EXPECT_EQ(watched.counts.notopple, 20);
  EXPECT_EQ(ToString(watched.monitor.WhyNotWell()), "object_slipped: mill1") << "no hand holds it";
}

TEST(LoadMonitorTest, WhatShouldStandOnTheTrayMustBeThere) {
  Watched there = WithPurpose(Watched::LoadOf({"mill"}), Purpose::Kind::kPutOnTray, "load0");
  there.Drive(0.0, 0.0, 0.2);
  EXPECT_EQ(ToString(there.monitor.WhyNotWell()), "");
  Watched below =
      WithPurpose({{OnFloor("load0", "mill", 1.2)}}, Purpose::Kind::kPutOnTray, "load0");
  EXPECT_EQ(ToString(below.monitor.WhyNotWell()), "object_fell: load0");
  Watched toppled = WithPurpose(Watched::LoadOf({"tower"}), Purpose::Kind::kPutOnTray, "load0");
  toppled.Drive(0.0, 0.9, 0.6);
  toppled.Drive(0.0, 0.0, 0.35);
  EXPECT_THAT(ToString(toppled.monitor.WhyNotWell()),
              testing::AnyOf("object_toppled: load0", "object_fell: load0"));
  EXPECT_EQ(toppled.monitor.falls(), 1);
}

TEST(LoadMonitorTest, WhatWasPutDownLiesAsSoonAsTheDetectorSaysSo) {
  const auto why = [](double hold_time) {
    Watched watched(Watched::LoadOf({"tower"}), {}, {0.2, hold_time, 0.5, 0.5}, {},
                    {Purpose::Kind::kPutOnTray, "load0", "rightarm1", "east"});
    watched.Drive(0.0, 0.9, 0.6);
    watched.Drive(0.0, 0.0, 0.1);
    EXPECT_GT(watched.monitor.tilt(), 0.2);
    EXPECT_EQ(watched.monitor.Down().size(), hold_time > 0.0 ? 0u : 1u);
    return ToString(watched.monitor.WhyNotWell());
  };
  EXPECT_EQ(why(0.0), "object_toppled: load0");
  EXPECT_EQ(why(10.0), "") << "it leans, but not for long";
}

TEST(LoadMonitorTest, WhatShouldStandOnAnAreaMustBeThere) {
  world::ObjectState mill = OnFloor("mill1", "mill", 2.5);  // the middle of East
  Watched there = WithPurpose({{mill}}, Purpose::Kind::kPutOnArea, "mill1");
  EXPECT_EQ(ToString(there.monitor.WhyNotWell()), "");
  mill.X_MO.translation.y() += 0.2;
  Watched beside = WithPurpose({{mill}}, Purpose::Kind::kPutOnArea, "mill1");
  EXPECT_EQ(ToString(beside.monitor.WhyNotWell()), "object_slipped: mill1");
  mill = OnFloor("mill1", "mill", 2.5);
  mill.attached_to = "tray";
  Watched held = WithPurpose({{mill}}, Purpose::Kind::kPutOnArea, "mill1");
  EXPECT_EQ(ToString(held.monitor.WhyNotWell()), "object_not_released: mill1");
}

}  // namespace
}  // namespace hires::imagination::load_monitor_test
