#include "hires/control/move_base_drive.h"

#include <gmock/gmock.h>

#include "hires/base/error.h"
#include "support/scenes.h"

namespace hires::control::move_base_drive_test {
namespace {

using base::ActionCall;
using base::ConfigError;
using geometry::Pose2;
using robot::Command;
using robot::Observation;
using skills::Progress;
using skills::Status;
using State = MoveBaseNews::State;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Somebody who says that he drives.
struct FakeServer : public MoveBaseServer {
  bool is_there{true};
  std::vector<Pose2> goals;
  int cancels{0};
  MoveBaseNews news;

  bool IsThere() override { return is_there; }
  void Go(const Pose2& X_MGoal) override {
    goals.push_back(X_MGoal);
    news = {State::kSent, ""};
  }
  void Cancel() override { ++cancels; }
  MoveBaseNews News() override { return news; }
};

class MoveBaseDriveTest : public ::testing::Test {
 protected:
  static skills::SkillSet RoomSkills() {
    return skills::MakeSkillSet(hires::test_support::Room(), hires::test_support::TrayRobot(), {},
                                {});
  }

  void Make(const ActionCall& action) {
    drive_ = MakeMoveBaseDrive(
        skills_, action, server_, [this] { return may_drive_; }, params_);
  }

  Status Look(double time, const Pose2& X_MB = {1.0, 2.0, 0.0}) {
    Observation seen;
    seen.time = time;
    seen.X_MB = X_MB;
    seen.obstacles_M = obstacles_M_;
    command_ = {};
    return drive_->Update(seen, &command_);
  }

  /// A drive to East that move_base has accepted.
  void Begin() {
    Make({"move_base_param", {"East", "slow"}});
    Look(0.0);
    server_->news = {State::kDriving, ""};
    ASSERT_EQ(Look(0.1).progress, Progress::kRunning);
  }

  std::string ReasonAfter(const MoveBaseNews& news, const Pose2& X_MB = {4.5, 2.0, 0.0}) {
    server_->news = news;
    const Status status = Look(1.0, X_MB);
    EXPECT_EQ(status.progress, Progress::kFailed);
    return ToString(status.failure);
  }

  skills::SkillSet skills_ = RoomSkills();
  const std::shared_ptr<FakeServer> server_ = std::make_shared<FakeServer>();
  const MoveBaseDriveParams params_;
  std::vector<geometry::Polygon> obstacles_M_;
  bool may_drive_{true};
  Command command_;
  std::unique_ptr<skills::Skill> drive_;
};

TEST_F(MoveBaseDriveTest, TheGoalIsTheAreaAndNoVelocityIsOurs) {
  Begin();
  ASSERT_EQ(server_->goals.size(), 1u);
  EXPECT_EQ(server_->goals[0].x, 4.5);
  EXPECT_EQ(server_->goals[0].y, 2.0);
  EXPECT_FALSE(command_.base_velocity);
  ASSERT_TRUE(command_.motion_set);
  EXPECT_EQ(command_.motion_set->max_linear_velocity, 0.30);
  EXPECT_EQ(drive_->phase(), "move_base");
}

TEST_F(MoveBaseDriveTest, NothingIsSentBeforeThereIsLeave) {
  may_drive_ = false;
  Make({"move_base", {"East"}});
  EXPECT_EQ(Look(0.0).progress, Progress::kRunning);
  EXPECT_EQ(Look(params_.start_patience).progress, Progress::kRunning);
  EXPECT_THAT(server_->goals, IsEmpty());
  EXPECT_EQ(drive_->phase(), "wait_for_leave");
  EXPECT_EQ(ToString(Look(params_.start_patience + 0.1).failure), "no_permit");
  drive_.reset();
  EXPECT_EQ(server_->cancels, 0);
}

TEST_F(MoveBaseDriveTest, AServerThatIsMissingIsWaitedForAndThenNamed) {
  server_->is_there = false;
  Make({"move_base", {"East"}});
  EXPECT_EQ(Look(0.0).progress, Progress::kRunning);
  EXPECT_EQ(ToString(Look(params_.start_patience + 0.1).failure), "no_controller: move_base");
  EXPECT_THAT(server_->goals, IsEmpty());
}

TEST_F(MoveBaseDriveTest, AServerThatDoesNotAnswerIsNamed) {
  Make({"move_base", {"East"}});
  Look(1.0);
  EXPECT_EQ(Look(1.0 + params_.answer_patience).progress, Progress::kRunning);
  EXPECT_EQ(ToString(Look(1.1 + params_.answer_patience).failure), "no_controller: move_base");
}

TEST_F(MoveBaseDriveTest, AServerThatDiesIsNamed) {
  Begin();
  server_->is_there = false;
  EXPECT_EQ(ToString(Look(1.0).failure), "no_controller: move_base");
}

TEST_F(MoveBaseDriveTest, WhatMoveBaseSaysBecomesOurReasons) {
  const auto failure = [](State state, const std::string& text) {
    return ToString(FailureOf({state, text}));
  };
  const std::string still = " Even after executing recovery behaviors.";
  EXPECT_EQ(failure(State::kAborted, "Failed to find a valid plan." + still), "unreachable");
  EXPECT_EQ(failure(State::kAborted, "Failed to find a valid control." + still), "stuck");
  EXPECT_EQ(failure(State::kAborted, "Robot is oscillating." + still), "stuck");
  EXPECT_EQ(failure(State::kAborted, ""), "unreachable");
  EXPECT_EQ(failure(State::kRejected, "invalid quaternion"), "unreachable");
  EXPECT_EQ(failure(State::kReplaced, ""), "interrupted");
  EXPECT_EQ(failure(State::kLost, ""), "no_controller: move_base");
  for (const State fine : {State::kNone, State::kSent, State::kDriving, State::kArrived}) {
    EXPECT_EQ(failure(fine, "Goal reached."), "");
  }
}

TEST_F(MoveBaseDriveTest, AnAbortedGoalEndsTheAction) {
  Begin();
  EXPECT_EQ(ReasonAfter({State::kAborted, "Failed to find a valid control."}), "stuck");
}

TEST_F(MoveBaseDriveTest, AGoalThatSomebodyElseReplacedEndsTheAction) {
  Begin();
  EXPECT_EQ(ReasonAfter({State::kReplaced, ""}), "interrupted");
}

TEST_F(MoveBaseDriveTest, ArrivedWithinOurOwnTolerancesIsSuccess) {
  Begin();
  server_->news = {State::kArrived, "Goal reached."};
  EXPECT_EQ(Look(9.0, {4.35, 2.1, 0.15}).progress, Progress::kSucceeded);  // 0.18 m, 0.15 rad
}

TEST_F(MoveBaseDriveTest, WhereMoveBaseStopsShortTheRestIsDrivenStraight) {
  Begin();
  server_->news = {State::kArrived, "Goal reached."};
  EXPECT_EQ(Look(9.0, {4.2, 2.0, 0.0}).progress, Progress::kRunning);  // 0.3 m
  EXPECT_EQ(drive_->phase(), "last_stretch");
  ASSERT_TRUE(command_.base_velocity);
  EXPECT_DOUBLE_EQ(command_.base_velocity->vx, skills_.blind.max_velocity);
  EXPECT_EQ(Look(9.1, {4.48, 2.0, 0.0}).progress, Progress::kSucceeded);
}

TEST_F(MoveBaseDriveTest, ATurnThatIsLeftIsDrivenToo) {
  Begin();
  server_->news = {State::kArrived, "Goal reached."};
  EXPECT_EQ(Look(9.0, {4.5, 2.0, 0.3}).progress, Progress::kRunning);
  EXPECT_LT(command_.base_velocity->wz, 0.0);
}

TEST_F(MoveBaseDriveTest, AnArrivalFarOffIsAMissedGoal) {
  Begin();
  EXPECT_EQ(ReasonAfter({State::kArrived, ""}, {3.5, 2.0, 0.1}), "goal_missed: 1.00 m, 0.10 rad");
  Begin();
  EXPECT_EQ(ReasonAfter({State::kArrived, ""}, {4.5, 2.0, 1.0}), "goal_missed: 0.00 m, 1.00 rad");
}

TEST_F(MoveBaseDriveTest, TheLastStretchIsNotDrivenIntoWhatIsSeen) {
  obstacles_M_ = {{{4.7, 1.9}, {4.8, 1.9}, {4.8, 2.1}, {4.7, 2.1}}};
  Begin();
  EXPECT_THAT(ReasonAfter({State::kArrived, ""}, {4.1, 2.0, 0.0}), HasSubstr("unreachable: "));
  EXPECT_FALSE(command_.base_velocity);
}

TEST_F(MoveBaseDriveTest, ACarsLastStretchIsLookedAtAsItIsDriven) {
  robot::Robot car = hires::test_support::TrayRobot();
  car.profile.base_controller.drive = robot::Drive::kCarLike;
  car.profile.base_controller.min_turning_radius = 0.8;
  skills_ = skills::MakeSkillSet(hires::test_support::Room(), car, {}, {});
  const Pose2 beside{4.5, 2.3, 0.0};
  Begin();
  server_->news = {State::kArrived, "Goal reached."};
  EXPECT_EQ(Look(9.0, beside).progress, Progress::kRunning);
  EXPECT_EQ(command_.base_velocity->vy, 0.0);
  EXPECT_NE(command_.base_velocity->vx, 0.0);
  // Straight to the side nothing would stand; it has to drive to and fro.
  obstacles_M_ = {{{5.0, 1.5}, {5.1, 1.5}, {5.1, 2.7}, {5.0, 2.7}},
                  {{3.9, 1.5}, {4.0, 1.5}, {4.0, 2.7}, {3.9, 2.7}}};
  Begin();
  EXPECT_THAT(ReasonAfter({State::kArrived, ""}, beside), HasSubstr("unreachable: "));
}

TEST_F(MoveBaseDriveTest, AWayThatACarTakesAnewIsLookedAtToo) {
  robot::Robot car = hires::test_support::TrayRobot();
  car.profile.base_controller.drive = robot::Drive::kCarLike;
  car.profile.base_controller.min_turning_radius = 0.8;
  skills_ = skills::MakeSkillSet(hires::test_support::Room(), car, {}, {});
  Begin();
  server_->news = {State::kArrived, "Goal reached."};
  ASSERT_EQ(Look(9.0, {4.5, 2.3, 0.0}).progress, Progress::kRunning);
  obstacles_M_ = {{{5.1, 1.5}, {5.2, 1.5}, {5.2, 2.9}, {5.1, 2.9}},
                  {{3.8, 1.5}, {3.9, 1.5}, {3.9, 2.9}, {3.8, 2.9}}};
  const skills::Status pushed = Look(9.1, {4.5, 1.5, 0.0});  // off its way, where it stands
  EXPECT_EQ(pushed.progress, Progress::kFailed);
  EXPECT_EQ(pushed.failure.code, base::FailureCode::kUnreachable);
  EXPECT_FALSE(command_.base_velocity);
}

TEST_F(MoveBaseDriveTest, TheGoalIsTakenBackWhereTheActionIsBrokenOff) {
  Begin();
  drive_.reset();
  EXPECT_EQ(server_->cancels, 1);
}

TEST_F(MoveBaseDriveTest, AGoalThatWasReachedIsNotTakenBack) {
  Begin();
  server_->news = {State::kArrived, "Goal reached."};
  Look(9.0, {4.5, 2.0, 0.0});
  drive_.reset();
  EXPECT_EQ(server_->cancels, 0);
}

TEST_F(MoveBaseDriveTest, OnlyLongWaysAreForMoveBase) {
  EXPECT_TRUE(IsForMoveBase(skills_, {"move_base", {"East"}}));
  EXPECT_TRUE(IsForMoveBase(skills_, {"Move_Base_Param", {"East", "slow"}}));
  EXPECT_FALSE(IsForMoveBase(skills_, {"move_base_blind", {"East"}}));
  EXPECT_FALSE(IsForMoveBase(skills_, {"pick_up_object", {"mug1", "leftarm1"}}));
}

TEST_F(MoveBaseDriveTest, AnActionThatMakesNoSenseIsTheErrorThatSkillsMake) {
  const auto complaint = [&](const ActionCall& action) -> std::string {
    try {
      Make(action);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "no complaint";
  };
  EXPECT_THAT(complaint({"move_base", {"Eest"}}), HasSubstr("did you mean 'east'"));
  EXPECT_THAT(complaint({"move_base_param", {"East", "slwo"}}), HasSubstr("slow"));
  EXPECT_THAT(complaint({"move_base", {}}), HasSubstr("has 0 arguments"));
}

}  // namespace
}  // namespace hires::control::move_base_drive_test
