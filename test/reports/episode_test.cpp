#include "reports/episode/episode.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "reports/episode/episode_steps.h"
#include "support/fake_frame_tree.h"

namespace hires::reports::episode_test {
namespace {

using geometry::Pose2;
using geometry::Twist2;
using robot::JointPositions;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::Not;
using testing::SizeIs;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kTick = 0.05;  // [s] between two readings
constexpr char kCounter[] = "premanipulationareaeastcounter1";
constexpr char kTable[] = "premanipulationareanorthtable1";

const imagination::ImaginationSetup& Restaurant() {
  static const auto setup = imagination::LoadImaginationSetup(
      imagination::ReadSetupConfig(HIRES_SOURCE_DIR "/config/scene.yaml"));
  return setup;
}

const EpisodeConfig& Config() {
  static const EpisodeConfig config = ReadEpisodeConfig(HIRES_SOURCE_DIR "/config/episode.yaml");
  return config;
}

Pose2 AreaAt(const std::string& name) { return Restaurant().skills->areas.at(name); }

const robot::ArmProfile& Arm(const std::string& name) {
  return Restaurant().scene->robot.profile.upper_body->arms.at(name);
}

/// A robot that does what a test says, and tells of it.
class Recording {
 public:
  explicit Recording(bool has_localisation = true) : has_localisation_(has_localisation) {}

  void Tell() {
    if (has_localisation_) {
      tree_->Tell("map", "odom_combined", time, geometry::Lift({}));
      builder.OnTransforms(time);
    }
    builder.OnJoints(time, {joints, {}});
    builder.OnOdometry(time, "odom_combined", "base_footprint", {X_MB, V_B});
  }
  void Rest(double seconds) {
    for (const double end = time + seconds; time < end - 0.5 * kTick; time += kTick) Tell();
  }
  /// Straight on, at a constant speed.
  void DriveTo(const Pose2& X_MGoal, double speed) {
    const Eigen::Vector2d way = X_MGoal.position() - X_MB.position();
    const int ticks = static_cast<int>(std::ceil(way.norm() / speed / kTick));
    const Pose2 from = X_MB;
    V_B = {way.norm() / (ticks * kTick), 0.0, 0.0};
    for (int i = 1; i <= ticks; ++i) {
      const Eigen::Vector2d p = from.position() + way * i / ticks;
      X_MB = {p.x(), p.y(), X_MGoal.yaw};
      Tell();
      time += kTick;
    }
    V_B = {};
  }
  /// All joints at once, within `seconds`.
  void MoveJoints(const JointPositions& to, double seconds) {
    const JointPositions from = joints;
    const int ticks = static_cast<int>(seconds / kTick);
    for (int i = 1; i <= ticks; ++i) {
      for (const auto& [name, position] : to) {
        joints[name] = from.at(name) + (position - from.at(name)) * i / ticks;
      }
      Tell();
      time += kTick;
    }
  }
  std::vector<EpisodeStep> Steps() {
    const std::vector<Episode> episodes = builder.Take();
    EXPECT_THAT(episodes, SizeIs(1));
    return StepsOf(episodes.at(0), Restaurant(), Config());
  }

  double time{100.0};  // [s]
  Pose2 X_MB{AreaAt(kCounter)};
  Twist2 V_B;
  JointPositions joints{Restaurant().scene->robot.profile.joints};

 private:
  const bool has_localisation_;
  std::shared_ptr<test_support::FakeFrameTree> tree_ =
      std::make_shared<test_support::FakeFrameTree>();

 public:
  EpisodeBuilder builder{Restaurant(), {"map", "odom_combined", "base_footprint"}, {}, tree_, 0.1};
};

JointPositions PostureOf(const std::string& arm, const std::string& posture) {
  JointPositions joints;
  for (std::size_t i = 0; i < Arm(arm).joints.size(); ++i) {
    joints[Arm(arm).joints[i]] = Arm(arm).postures.at(posture).front()[i];
  }
  return joints;
}

base::ActionCall DriveTo(const std::string& area) { return {"move_base", {area}}; }

// ---- Steps that were asked for.

TEST(EpisodeTest, AGoalIsAStepThatBeginsInTheStateOfThatMoment) {
  Recording robot;
  robot.builder.OnKnownObjects(
      100.0,
      {{{"peppermill1", "peppermill_thesis", geometry::Lift({5.4, 10.1, 0.0}, 0.75), {}, ""}}});
  robot.Rest(1.0);
  const double begin = robot.time;
  robot.builder.OnGoal("a", DriveTo(kTable), begin);
  robot.DriveTo(AreaAt(kTable), 0.5);
  const double duration = robot.time - begin;
  robot.builder.OnResult("a", robot.time, duration, ActionFate::kSucceeded, {});
  const auto steps = robot.Steps();
  ASSERT_THAT(steps, SizeIs(1));
  EXPECT_EQ(steps[0].action, DriveTo(kTable));
  EXPECT_EQ(steps[0].duration, duration);
  EXPECT_EQ(steps[0].why_not, "");
  EXPECT_NEAR(steps[0].start.robot.X_MB.x, AreaAt(kCounter).x, 0.05);
  EXPECT_NEAR(steps[0].start.robot.joints.at("torso_lift_joint"), 0.295, 1e-9);
  ASSERT_THAT(steps[0].start.world.objects, SizeIs(1));
  EXPECT_EQ(steps[0].start.world.objects[0].name, "peppermill1");
}

TEST(EpisodeTest, AStepWithoutAnEndOrWithAnEndThatSomebodyMadeIsNotCompared) {
  Recording robot;
  robot.Rest(1.0);
  robot.builder.OnGoal("a", DriveTo(kTable), robot.time);
  robot.builder.OnGoal("b", DriveTo(kTable), robot.time);
  robot.builder.OnResult("b", robot.time + 1.0, 1.0, ActionFate::kPreempted, {});
  robot.Rest(2.0);
  const auto steps = robot.Steps();
  ASSERT_THAT(steps, SizeIs(2));
  EXPECT_THAT(steps[0].why_not, HasSubstr("result was not recorded"));
  EXPECT_THAT(steps[1].why_not, HasSubstr("somebody ended it"));
}

TEST(EpisodeTest, AStepInWhichNothingIsKnownOfTheRobotForAWhileIsNotCompared) {
  Recording robot;
  robot.Rest(1.0);
  robot.builder.OnGoal("a", DriveTo(kTable), robot.time);
  robot.Rest(1.0);
  robot.time += 2.5;  // nothing is recorded
  robot.Rest(1.0);
  robot.builder.OnResult("a", robot.time, 4.5, ActionFate::kSucceeded, {});
  EXPECT_THAT(robot.Steps().at(0).why_not, HasSubstr("nothing is known of the robot"));
}

TEST(EpisodeTest, AnActionThatNobodyKnowsIsNamed) {
  Recording robot;
  robot.Rest(1.0);
  robot.builder.OnGoal("a", {"make_tea", {}}, robot.time);
  robot.Rest(1.0);
  robot.builder.OnResult("a", robot.time, 1.0, ActionFate::kSucceeded, {});
  EXPECT_THAT(robot.Steps().at(0).why_not, HasSubstr("make_tea"));
}

TEST(EpisodeTest, AGoalOrResultThatWasRecordedTwiceCountsOnce) {
  Recording robot;
  robot.Rest(1.0);
  const double begin = robot.time;
  for (int i = 0; i < 2; ++i) robot.builder.OnGoal("a", DriveTo(kTable), begin);
  robot.Rest(1.0);
  for (int i = 0; i < 2; ++i) {
    robot.builder.OnResult("a", robot.time, 1.0, ActionFate::kSucceeded, {});
  }
  robot.builder.OnResult("b", robot.time, 1.0, ActionFate::kSucceeded, {});
  robot.builder.OnGoal("a", DriveTo(kTable), robot.time);  // the same id, later: another one
  const auto& dropped = robot.builder.dropped();
  EXPECT_EQ(dropped.at("goals: recorded before"), 1);
  EXPECT_EQ(dropped.at("results: recorded before"), 1);
  EXPECT_EQ(dropped.at("results: their goal was not recorded"), 1);
  EXPECT_THAT(robot.Steps(), SizeIs(2));
}

TEST(EpisodeTest, JointsOfArmsAndTorsoOfWhichNothingIsToldAreNamed) {
  Recording whole, partial, foreign;
  whole.Rest(1.0);
  EXPECT_THAT(whole.builder.UntoldJoints(), IsEmpty());
  partial.joints = PostureOf("rightarm1", "armtosideposture");
  partial.joints["fl_caster_rotation_joint"] = 0.0;
  partial.Rest(1.0);
  EXPECT_THAT(partial.builder.UntoldJoints(), Contains("torso_lift_joint"));
  EXPECT_THAT(partial.builder.UntoldJoints(), IsSupersetOf(Arm("leftarm1").joints));
  EXPECT_THAT(partial.builder.UntoldJoints(), Not(Contains(Arm("rightarm1").joints.front())));
  foreign.joints = {{"shoulder_pan", 0.0}, {"fl_caster_rotation_joint", 0.0}};
  foreign.Rest(1.0);
  EXPECT_THAT(foreign.builder.UntoldJoints(), IsSupersetOf(Arm("rightarm1").joints));
  EXPECT_THAT(foreign.builder.UntoldJoints(), IsSupersetOf(Arm("leftarm1").joints));
}

// ---- Motions that are found.

TEST(EpisodeTest, ADriveIsFoundAndTakenForTheMotionSetOfItsSpeed) {
  for (const auto& [speed, set] : {std::pair{0.5, "fast"}, std::pair{0.29, "slow"}}) {
    Recording robot;
    robot.Rest(2.0);
    robot.DriveTo(AreaAt(kTable), speed);
    const double end = robot.time;
    robot.Rest(2.0);
    const auto steps = robot.Steps();
    ASSERT_THAT(steps, SizeIs(1));
    EXPECT_EQ(steps[0].action, (base::ActionCall{"move_base_param", {kTable, set}}));
    EXPECT_NEAR(steps[0].begin, 102.0, 0.11);
    EXPECT_NEAR(steps[0].begin + steps[0].duration, end, 0.11);
    EXPECT_EQ(steps[0].fate, ActionFate::kSucceeded);
    EXPECT_FALSE(steps[0].goal);
    EXPECT_THAT(steps[0].motion, HasSubstr("drove"));
  }
}

TEST(EpisodeTest, AShortStraightDriveIsABlindOneAndADriveToNoAreaHasAGoalOfItsOwn) {
  Recording robot;
  robot.Rest(2.0);
  const Pose2 goal{robot.X_MB.x + 1.0, robot.X_MB.y, robot.X_MB.yaw};
  robot.DriveTo(goal, 0.3);
  robot.Rest(2.0);
  const auto steps = robot.Steps();
  ASSERT_THAT(steps, SizeIs(1));
  EXPECT_EQ(steps[0].action.name, "move_base_blind");
  ASSERT_TRUE(steps[0].goal);
  EXPECT_NEAR(steps[0].goal->x, goal.x, 0.02);
  const auto setup = WithGoals(Restaurant(), steps);
  EXPECT_EQ(setup.skills->areas.count(steps[0].action.arguments.front()), 1u);
  EXPECT_NO_THROW(skills::MakeSkill(*setup.skills, steps[0].action));
}

TEST(EpisodeTest, ADriveThatGoesOnAtTheEndOfTheRecordingIsLeftOut) {
  Recording robot;
  robot.Rest(2.0);
  robot.DriveTo(AreaAt(kTable), 0.5);
  EXPECT_THAT(robot.Steps(), IsEmpty());
}

TEST(EpisodeTest, MotionsOfArmsAndTorsoAreTakenForThePosturesInWhichTheyEnd) {
  Recording robot;
  robot.Rest(2.0);
  JointPositions untucked = PostureOf("leftarm1", "armuntuckedposture");
  untucked.merge(PostureOf("rightarm1", "armuntuckedposture"));
  robot.MoveJoints(untucked, 3.0);
  robot.Rest(2.0);
  robot.MoveJoints({{"torso_lift_joint", 0.01}}, 8.0);
  robot.Rest(2.0);
  robot.MoveJoints(PostureOf("rightarm1", "armtosideposture"), 3.0);
  robot.Rest(2.0);
  robot.MoveJoints({{Arm("leftarm1").joints[3], -0.5}}, 2.0);
  robot.Rest(2.0);
  const auto steps = robot.Steps();
  ASSERT_THAT(steps, SizeIs(4));
  EXPECT_EQ(steps[0].action,
            (base::ActionCall{"tuck_arms", {"armuntuckedposture", "armuntuckedposture"}}));
  EXPECT_EQ(steps[1].action, (base::ActionCall{"move_torso", {"torsodownposture"}}));
  EXPECT_EQ(steps[2].action, (base::ActionCall{"move_arm_to_side", {"rightarm1"}}));
  EXPECT_EQ(steps[3].action.name, "");
  EXPECT_THAT(steps[3].why_not, HasSubstr("leftarm1 ended in no posture"));
  EXPECT_THAT(steps[0].start.robot.joints.at(Arm("leftarm1").joints[0]),
              testing::DoubleNear(0.06024, 0.05));
}

// ---- Bad recordings.

TEST(EpisodeTest, WithoutAMessageThereIsNoEpisode) {
  Recording robot;
  EXPECT_THAT(robot.builder.Take(), IsEmpty());
  EXPECT_EQ(robot.builder.MissingText(), "odometry");
}

TEST(EpisodeTest, WithoutTransformsWhereTheRobotStandsIsNeverKnown) {
  Recording robot(false);
  robot.Rest(2.0);
  EXPECT_EQ(robot.builder.MissingText(), "the transform map -> odom_combined");
  EXPECT_THAT(robot.builder.Take(), IsEmpty());
}

TEST(EpisodeTest, AClockThatJumpsBackBeginsAnotherEpisode) {
  Recording robot;
  robot.Rest(3.0);
  robot.builder.OnGoal("a", DriveTo(kTable), robot.time);
  robot.time = 20.0;
  robot.Rest(3.0);
  const auto episodes = robot.builder.Take();
  ASSERT_THAT(episodes, SizeIs(2));
  EXPECT_THAT(episodes[0].actions, SizeIs(1));
  EXPECT_GE(episodes[0].samples.front().time, 100.0);
  EXPECT_LE(episodes[1].samples.back().time, 23.0);
  for (const Episode& episode : episodes) {
    for (std::size_t i = 1; i < episode.samples.size(); ++i) {
      EXPECT_LT(episode.samples[i - 1].time, episode.samples[i].time);
    }
  }
}

TEST(EpisodeTest, WhatIsNoNumberIsLeftOutAndCounted) {
  Recording robot;
  robot.Rest(1.0);
  robot.builder.OnOdometry(robot.time, "odom_combined", "base_footprint", {{kNan, 0.0, 0.0}, {}});
  robot.builder.OnJoints(robot.time, {{{"torso_lift_joint", kNan}}, {}});
  robot.builder.OnGoal("a", DriveTo(kTable), kNan);
  robot.Rest(1.0);
  EXPECT_THAT(robot.builder.dropped(), SizeIs(3));
  for (const Episode& episode : robot.builder.Take()) {
    EXPECT_THAT(episode.actions, IsEmpty());
    for (const EpisodeSample& sample : episode.samples) {
      EXPECT_TRUE(std::isfinite(sample.X_WB.x));
      for (const double joint : sample.joints) EXPECT_TRUE(std::isfinite(joint));
    }
  }
}

TEST(EpisodeTest, AJointThatTheRobotDoesNotHaveChangesNothing) {
  Recording robot, other;
  other.joints["a_third_arm_joint"] = 1.0;
  robot.Rest(1.0);
  other.Rest(1.0);
  const auto a = robot.builder.Take(), b = other.builder.Take();
  EXPECT_EQ(a.at(0).joint_names, b.at(0).joint_names);
  EXPECT_EQ(a.at(0).samples.back().joints, b.at(0).samples.back().joints);
}

TEST(EpisodeTest, AResultWithoutItsGoalSaysNothing) {
  Recording robot;
  robot.Rest(1.0);
  robot.builder.OnResult("lost", robot.time, 1.0, ActionFate::kSucceeded, {});
  EXPECT_THAT(robot.Steps(), IsEmpty());
  EXPECT_THAT(robot.builder.dropped(), SizeIs(1));
}

}  // namespace
}  // namespace hires::reports::episode_test
