#include "hires/control/action_runner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <stdexcept>

#include "hires/actions/catalogue.h"
#include "support/scenes.h"

namespace hires::control::action_runner_test {
namespace {

using base::Failure;
using robot::Command;
using robot::Observation;
using skills::Progress;
using skills::Status;
using Code = base::FailureCode;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// What a scripted skill was shown.
struct Seen {
  std::vector<double> times;
  std::vector<double> object_times;
};

/// Drives at 0.5 m/s for some looks, and then ends as it is told.
class ScriptedSkill : public skills::Skill {
 public:
  ScriptedSkill(int looks, Status end, std::shared_ptr<Seen> seen = std::make_shared<Seen>())
      : looks_(looks), end_(std::move(end)), seen_(std::move(seen)) {}

  Status Update(const Observation& observation, Command* command) override {
    seen_->times.push_back(observation.time);
    for (const auto& object : observation.objects) seen_->object_times.push_back(object.time);
    if (looks_-- <= 0) return end_;
    command->base_velocity = geometry::Twist2{0.5, 0.0, 0.0};
    return {};
  }
  double period() const override { return 0.1; }
  std::string phase() const override { return "scripted"; }

 private:
  int looks_;
  Status end_;
  std::shared_ptr<Seen> seen_;
};

class ThrowingSkill : public skills::Skill {
 public:
  Status Update(const Observation&, Command*) override { throw std::runtime_error("a fault"); }
  double period() const override { return 0.1; }
};

/// Thinks until it is let go.
class SlowSkill : public skills::Skill {
 public:
  explicit SlowSkill(std::shared_future<void> gate) : gate_(std::move(gate)) {}
  Status Update(const Observation&, Command* command) override {
    gate_.wait();
    command->base_velocity = geometry::Twist2{9.0, 0.0, 0.0};
    return {};
  }
  double period() const override { return 0.1; }

 private:
  std::shared_future<void> gate_;
};

struct Ended {
  int id;
  ActionEnd end;
  std::string failure;
  double elapsed;
};

class ActionRunnerTest : public ::testing::Test {
 protected:
  Failure Start(int id, const std::string& action, std::unique_ptr<skills::Skill> skill,
                double limit = 0.0) {
    const base::ActionCall call{action, {"leftArm1", "leftArm1"}};
    const actions::ActionSpec& spec = actions::OwnActions().Get(action);
    return runner_.Start(id, call, actions::GroupsOf(spec, call), std::move(skill), limit, now_);
  }

  /// One look at `now`, and what the skills make of it.
  void Look(double now, double speed = 0.5) {
    now_ = now;
    Observation seen;
    seen.time = now;
    seen.V_B.vx = speed;
    seen.objects = {{"mug1", "mug", {}, now - 1.0, ""}};
    runner_.Look(now, seen);
    CollectAll();
  }

  void CollectAll() {
    while (runner_.is_thinking()) runner_.Collect();
  }

  double now_{100.0};
  std::vector<Ended> ended_;
  std::vector<Command> sent_;
  robot::Robot robot_ = hires::test_support::TrayRobot();
  ActionRunner runner_{robot_,
                       {},
                       {[this](const Command& command) { sent_.push_back(command); },
                        [this](const ActionNews& news, ActionEnd end, const Failure& failure) {
                          ended_.push_back({news.id, end, ToString(failure), news.elapsed});
                        },
                        [] {}}};
};

std::unique_ptr<ScriptedSkill> Endless() { return std::make_unique<ScriptedSkill>(1000, Status{}); }

TEST_F(ActionRunnerTest, ASkillCountsTimeFromItsFirstLookAndIsAskedAtItsPeriod) {
  auto seen = std::make_shared<Seen>();
  Start(1, "move_base", std::make_unique<ScriptedSkill>(2, skills::Succeeded(), seen));
  for (const double now : {200.0, 200.05, 200.1, 200.15, 200.2}) Look(now);
  ASSERT_EQ(seen->times.size(), 3u);
  EXPECT_NEAR(seen->times[0], 0.0, 1e-9);
  EXPECT_NEAR(seen->times[1], 0.1, 1e-9);
  EXPECT_NEAR(seen->times[2], 0.2, 1e-9);
  EXPECT_NEAR(seen->object_times[0], -1.0, 1e-9);
  ASSERT_EQ(ended_.size(), 1u);
  EXPECT_EQ(ended_[0].end, ActionEnd::kSucceeded);
  EXPECT_NEAR(ended_[0].elapsed, 0.2, 1e-9);
}

TEST_F(ActionRunnerTest, ALateLookIsNotMadeUpFor) {
  auto seen = std::make_shared<Seen>();
  Start(1, "move_base", std::make_unique<ScriptedSkill>(100, Status{}, seen));
  for (const double now : {200.0, 201.0, 201.05, 201.1}) Look(now);
  ASSERT_EQ(seen->times.size(), 3u);
  EXPECT_NEAR(seen->times[2], 1.1, 1e-9);
}

TEST_F(ActionRunnerTest, ThoseThatNeedTheSameAreRefusedWithTheOneThatHasIt) {
  EXPECT_FALSE(Start(1, "move_base", Endless()));
  EXPECT_FALSE(Start(2, "move_torso", Endless()));
  EXPECT_EQ(ToString(Start(3, "move_base_blind", Endless())),
            "busy: move_base(leftArm1, leftArm1) needs base");
  EXPECT_EQ(ToString(Start(4, "pick_up_object", Endless())),
            "busy: move_base(leftArm1, leftArm1) needs base");
  EXPECT_FALSE(Start(5, "tuck_arms", Endless()));
  EXPECT_EQ(ToString(Start(6, "move_arm_to_side", Endless())),
            "busy: tuck_arms(leftArm1, leftArm1) needs leftarm1");
}

TEST_F(ActionRunnerTest, AnEndFreesWhatWasNeeded) {
  Start(1, "move_base", std::make_unique<ScriptedSkill>(0, skills::Succeeded()));
  Look(200.0);
  EXPECT_TRUE(runner_.is_idle());
  EXPECT_FALSE(Start(2, "move_base", Endless()));
}

TEST_F(ActionRunnerTest, AFailedSkillEndsWhenTheBaseStands) {
  Start(1, "move_base", std::make_unique<ScriptedSkill>(0, skills::Failed(Code::kNoPath)));
  Look(200.0);
  Look(200.1, 0.4);
  EXPECT_THAT(ended_, IsEmpty());
  EXPECT_TRUE(runner_.is_stopping());
  Look(200.2, 0.0);
  ASSERT_EQ(ended_.size(), 1u);
  EXPECT_EQ(ended_[0].end, ActionEnd::kFailed);
  EXPECT_EQ(ended_[0].failure, "no_path");
}

TEST_F(ActionRunnerTest, CancellingBrakesAlongARamp) {
  Start(1, "move_base", Endless());
  Look(200.0);
  sent_.clear();
  runner_.Cancel(1);
  Look(200.1, 0.4);
  Look(200.3, 0.2);
  Look(200.5, 0.0);
  ASSERT_EQ(ended_.size(), 1u);
  EXPECT_EQ(ended_[0].end, ActionEnd::kPreempted);
  std::vector<double> wanted;
  for (const Command& command : sent_) wanted.push_back(command.base_velocity->vx);
  // From 0.5 m/s at 1 m/s^2.
  ASSERT_EQ(wanted.size(), 4u);
  EXPECT_NEAR(wanted[0], 0.5, 1e-9);
  EXPECT_NEAR(wanted[1], 0.4, 1e-9);
  EXPECT_NEAR(wanted[2], 0.2, 1e-9);
  EXPECT_NEAR(wanted[3], 0.0, 1e-9);
}

TEST_F(ActionRunnerTest, CancellingBeforeTheFirstLookMovesNothing) {
  Start(1, "move_base", Endless());
  runner_.Cancel(1);
  ASSERT_EQ(ended_.size(), 1u);
  EXPECT_EQ(ended_[0].end, ActionEnd::kPreempted);
  EXPECT_THAT(sent_, IsEmpty());
  runner_.Cancel(1);  // it has ended: nothing more
  EXPECT_EQ(ended_.size(), 1u);
}

TEST_F(ActionRunnerTest, WhatASkillSaysAfterItWasCancelledIsNotHeard) {
  std::promise<void> gate;
  Start(1, "move_base", std::make_unique<SlowSkill>(gate.get_future().share()));
  runner_.Look(200.0, {});
  runner_.Cancel(1);
  runner_.Look(200.1, {});
  ASSERT_EQ(ended_.size(), 1u);  // it stands, whatever the skill still thinks
  EXPECT_TRUE(runner_.is_idle());
  gate.set_value();
  EXPECT_FALSE(Start(2, "move_base", Endless()));
  Look(200.2);
  for (const Command& command : sent_) EXPECT_LT(command.base_velocity->vx, 1.0);
}

/// Drives along a path that it tells.
class ShowingSkill : public ScriptedSkill {
 public:
  using ScriptedSkill::ScriptedSkill;
  std::optional<skills::DriveView> drive_view() const override {
    skills::DriveView view;
    view.path = path;
    return view;
  }
  std::shared_ptr<const std::vector<geometry::Pose2>> path =
      std::make_shared<const std::vector<geometry::Pose2>>(3);
};

TEST_F(ActionRunnerTest, WhatASkillDrivesByIsToldUntilItIsBrokenOff) {
  auto skill = std::make_unique<ShowingSkill>(1000, Status{});
  const auto path = skill->path;
  Start(1, "move_base", std::move(skill));
  Start(2, "move_torso", Endless());
  EXPECT_FALSE(runner_.News()[0].drive) << "it has not begun";
  Look(200.0);
  ASSERT_TRUE(runner_.News()[0].drive);
  EXPECT_EQ(runner_.News()[0].drive->path, path);
  EXPECT_FALSE(runner_.News()[1].drive);
  runner_.Cancel(1);
  EXPECT_TRUE(runner_.is_stopping());
  EXPECT_FALSE(runner_.News()[0].drive);
}

TEST_F(ActionRunnerTest, ASlowSkillKeepsNoOtherFromItsLooks) {
  std::promise<void> gate;
  Start(1, "move_torso", std::make_unique<SlowSkill>(gate.get_future().share()));
  Start(2, "move_base", std::make_unique<ScriptedSkill>(1, skills::Succeeded()));
  runner_.Look(200.0, {});
  while (ended_.empty()) {  // until the driving skill has had its two looks
    runner_.Collect();
    if (!sent_.empty()) runner_.Look(200.1, {});
  }
  EXPECT_EQ(ended_[0].id, 2);
  EXPECT_TRUE(runner_.is_thinking());
  gate.set_value();
}

TEST_F(ActionRunnerTest, TheTimeLimitOfTheGoalComesBeforeTheConfigured) {
  Start(1, "move_base", Endless(), 1.0);
  Look(200.0);
  Look(200.9);
  EXPECT_FALSE(runner_.is_stopping());
  Look(201.0);
  Look(201.1, 0.0);
  ASSERT_EQ(ended_.size(), 1u);
  EXPECT_EQ(ended_[0].failure, "timed_out");
}

TEST_F(ActionRunnerTest, AFaultOfASkillEndsItAloneWithItsWords) {
  Start(1, "move_base", std::make_unique<ThrowingSkill>());
  Start(2, "move_torso", Endless());
  Look(200.0);
  Look(200.1, 0.0);
  ASSERT_EQ(ended_.size(), 1u);
  EXPECT_EQ(ended_[0].failure, "internal_error: a fault");
  EXPECT_THAT(runner_.Running(), ElementsAre("move_torso(leftArm1, leftArm1)"));
}

TEST_F(ActionRunnerTest, ABlindRobotStopsAndSaysSo) {
  Start(1, "move_base", Endless());
  Look(200.0);
  runner_.CheckFreshness(200.29);
  EXPECT_THAT(ended_, IsEmpty());
  sent_.clear();
  runner_.CheckFreshness(200.31, "joint_states");
  ASSERT_EQ(ended_.size(), 1u);
  EXPECT_EQ(ended_[0].end, ActionEnd::kFailed);
  EXPECT_THAT(ended_[0].failure, testing::AllOf(testing::HasSubstr("stale_observation: 0.31 s"),
                                                testing::HasSubstr("0.3 s (sens"),
                                                testing::HasSubstr("comes on joint_states")));
  ASSERT_EQ(sent_.size(), 1u);
  EXPECT_EQ(sent_[0].base_velocity->vx, 0.0);
}

TEST_F(ActionRunnerTest, WithALoadABlindRobotLeavesItsBaseToTheGuard) {
  runner_.SetBraking({{0.5, 2.0}, {}});
  Start(1, "move_base", Endless());
  Look(200.0);
  sent_.clear();
  runner_.CheckFreshness(200.31);
  ASSERT_EQ(ended_.size(), 1u);
  for (const Command& command : sent_) EXPECT_FALSE(command.base_velocity);
}

TEST_F(ActionRunnerTest, WithALoadTheBaseStopsAsTheLoadBearsIt) {
  const navigation::BrakingLimits limits{0.5, 2.0};
  runner_.SetBraking({limits, {}});
  Start(1, "move_base", Endless());
  Look(200.0);
  sent_.clear();
  runner_.Cancel(1);
  const double dt = 0.01;
  for (int i = 1; i <= 200; ++i) Look(200.0 + dt * i);
  double speed = 0.5, deceleration = 0.0;
  ASSERT_GT(sent_.size(), 100u);
  for (std::size_t i = 1; i < sent_.size(); ++i) {
    const double next = sent_[i].base_velocity->vx;
    const double now = (speed - next) / dt;
    EXPECT_LE(now, limits.max_deceleration + 1e-6);
    EXPECT_LE(now - deceleration, limits.max_jerk * dt + 1e-6);
    speed = next;
    deceleration = now;
  }
  EXPECT_EQ(speed, 0.0);
}

TEST_F(ActionRunnerTest, EverythingFailsForOneReason) {
  Start(1, "move_base", Endless());
  Start(2, "move_torso", Endless());
  Look(200.0);
  Start(3, "look_at", Endless());  // has not moved anything
  runner_.FailAll(Code::kMotorsHalted);
  ASSERT_EQ(ended_.size(), 1u);
  EXPECT_EQ(ended_[0].id, 3);
  Look(200.1, 0.0);
  Look(200.2, 0.0);
  ASSERT_EQ(ended_.size(), 3u);
  for (const Ended& ended : ended_) {
    EXPECT_EQ(ended.end, ActionEnd::kFailed);
    EXPECT_EQ(ended.failure, "motors_halted");
  }
}

TEST_F(ActionRunnerTest, ARobotThatSeesNothingAtAllFailsTheSameWay) {
  Start(1, "move_base", Endless());  // at 100 s, and no look ever
  runner_.CheckFreshness(100.29);
  EXPECT_THAT(ended_, IsEmpty());
  runner_.CheckFreshness(100.4);
  ASSERT_EQ(ended_.size(), 1u);
  EXPECT_THAT(ended_[0].failure, testing::HasSubstr("computer is overloaded"));
  EXPECT_THAT(sent_, IsEmpty());
}

TEST_F(ActionRunnerTest, WhatNobodySeesStopIsGivenUp) {
  Start(1, "move_base", Endless());
  Look(200.0);
  runner_.Cancel(1);
  EXPECT_THAT(ended_, IsEmpty());
  runner_.GiveUpStopping();
  ASSERT_EQ(ended_.size(), 1u);
  EXPECT_EQ(ended_[0].end, ActionEnd::kPreempted);
}

TEST_F(ActionRunnerTest, TheHeadLooksAtNothingElseWhileAnObjectIsPickedUp) {
  EXPECT_FALSE(Start(1, "pick_up_object", Endless()));
  EXPECT_EQ(ToString(Start(2, "look_at", Endless())),
            "busy: pick_up_object(leftArm1, leftArm1) needs head");
}

}  // namespace
}  // namespace hires::control::action_runner_test
